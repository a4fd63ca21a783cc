-- What is known of a visit besides its answers.
-- The browser's own key of its wish to begin: a lost reply is asked for again, and begins nothing twice.
ALTER TABLE sessions ADD COLUMN start_key TEXT;
CREATE UNIQUE INDEX sessions_by_start_key ON sessions (study_id, start_key) WHERE start_key IS NOT NULL;
-- Whose it is: a participant's, a researcher's trial run, or a simulation's. The analysis is of participants alone.
ALTER TABLE sessions ADD COLUMN kind TEXT NOT NULL DEFAULT 'participant' CHECK (kind IN ('participant', 'pilot', 'simulated'));
-- What was noticed when it began, as a JSON list of words.
ALTER TABLE sessions ADD COLUMN flags TEXT NOT NULL DEFAULT '[]' CHECK (json_valid(flags));
ALTER TABLE sessions ADD COLUMN user_agent TEXT;
