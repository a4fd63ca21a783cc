-- Who is who: a person's sessions of a study are found by their id.
CREATE INDEX sessions_by_subject ON sessions (study_id, subject_id);
-- What is noticed from now on when a session begins is noticed of those before too.
UPDATE sessions SET flags = json_insert(flags, '$[#]', 'repeated_id')
WHERE subject_id <> session_id AND EXISTS (
    SELECT 1 FROM sessions earlier WHERE earlier.study_id = sessions.study_id AND earlier.subject_id = sessions.subject_id
    AND earlier.session_id < sessions.session_id AND earlier.session_id <> earlier.subject_id
);
