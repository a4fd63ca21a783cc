-- Study files, versions of studies and answers of any kind. What was stored before is brought over by the store when it opens
-- (crates/store/src/upgrade.rs), which ends by dropping study_stimuli: while that table is there, it has yet to be done.

-- A file is what a participant reads; a version is what answers are pooled by: a design and the pictures it shows. Several files can have one.
ALTER TABLE studies RENAME TO study_files;
ALTER TABLE study_files RENAME COLUMN config_hash TO file_hash;
ALTER TABLE study_files RENAME COLUMN config TO definition;
ALTER TABLE study_stimuli RENAME COLUMN config_hash TO file_hash;

CREATE TABLE versions (
    study_id        TEXT NOT NULL,
    version         TEXT NOT NULL CHECK (length(version) = 64),
    design_hash     TEXT NOT NULL CHECK (length(design_hash) = 64),
    file_hash       TEXT NOT NULL,
    first_served_at TEXT NOT NULL,
    last_served_at  TEXT NOT NULL,
    PRIMARY KEY (study_id, version),
    FOREIGN KEY (study_id, file_hash) REFERENCES study_files (study_id, file_hash) DEFERRABLE INITIALLY DEFERRED
) STRICT;

-- pixels_sha256 is over decoded pixels: a file that is packed anew shows what it showed.
ALTER TABLE stimuli ADD COLUMN pixels_sha256 TEXT;
ALTER TABLE stimuli ADD COLUMN width INTEGER;
ALTER TABLE stimuli ADD COLUMN height INTEGER;

-- What a version shows: written once.
CREATE TABLE version_stimuli (
    study_id      TEXT NOT NULL,
    version       TEXT NOT NULL,
    item_id       TEXT NOT NULL,
    condition     TEXT NOT NULL,
    sha256        TEXT NOT NULL REFERENCES stimuli (sha256),
    pixels_sha256 TEXT NOT NULL,
    provenance    TEXT NOT NULL CHECK (json_valid(provenance)),
    PRIMARY KEY (study_id, version, item_id, condition),
    FOREIGN KEY (study_id, version) REFERENCES versions (study_id, version)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER version_stimuli_no_update BEFORE UPDATE ON version_stimuli
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
CREATE TRIGGER version_stimuli_no_delete BEFORE DELETE ON version_stimuli
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
CREATE TRIGGER version_stimuli_no_replace BEFORE INSERT ON version_stimuli
WHEN EXISTS (SELECT 1 FROM version_stimuli WHERE study_id = NEW.study_id AND version = NEW.version
             AND item_id = NEW.item_id AND condition = NEW.condition)
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;

DROP INDEX sessions_by_study;
ALTER TABLE sessions RENAME COLUMN config_hash TO file_hash;
ALTER TABLE sessions ADD COLUMN version TEXT;
-- Whether answers will decide more trials.
ALTER TABLE sessions ADD COLUMN more INTEGER NOT NULL DEFAULT 0 CHECK (more IN (0, 1));
-- SHA-256 of the consent text that was agreed to.
ALTER TABLE sessions ADD COLUMN consent_sha256 TEXT;
CREATE INDEX sessions_by_version ON sessions (study_id, version, slot, completed_at, last_seen_at);
CREATE TRIGGER sessions_have_a_version BEFORE INSERT ON sessions
WHEN NOT EXISTS (SELECT 1 FROM versions WHERE study_id = NEW.study_id AND version IS NEW.version)
BEGIN SELECT RAISE(ABORT, 'a session belongs to a version'); END;
CREATE TRIGGER sessions_keep_their_version BEFORE UPDATE OF session_id, study_id, version ON sessions
WHEN OLD.version IS NOT NULL
AND (NEW.session_id <> OLD.session_id OR NEW.study_id <> OLD.study_id OR NEW.version IS NOT OLD.version)
BEGIN SELECT RAISE(ABORT, 'a session keeps its version'); END;
CREATE TRIGGER sessions_no_delete BEFORE DELETE ON sessions
BEGIN SELECT RAISE(ABORT, 'a session keeps its version'); END;
CREATE TRIGGER sessions_no_replace BEFORE INSERT ON sessions
WHEN EXISTS (SELECT 1 FROM sessions WHERE rowid = NEW.rowid OR session_id = NEW.session_id)
BEGIN SELECT RAISE(ABORT, 'a session keeps its version'); END;
-- What a version shows is complete when its first session begins.
CREATE TRIGGER version_stimuli_complete BEFORE INSERT ON version_stimuli
WHEN EXISTS (SELECT 1 FROM sessions WHERE study_id = NEW.study_id AND version = NEW.version)
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;

-- Plans grow: a trial is appended when it is decided, from the answers up to after_seq (0: from none).
CREATE TABLE session_trials (
    session_id  TEXT NOT NULL REFERENCES sessions (session_id),
    trial_index INTEGER NOT NULL CHECK (trial_index >= 0),
    trial       TEXT NOT NULL CHECK (json_valid(trial)),
    decided_at  TEXT NOT NULL,
    after_seq   INTEGER NOT NULL CHECK (after_seq >= 0),
    PRIMARY KEY (session_id, trial_index)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER session_trials_no_update BEFORE UPDATE ON session_trials
BEGIN SELECT RAISE(ABORT, 'plans are append-only'); END;
CREATE TRIGGER session_trials_no_delete BEFORE DELETE ON session_trials
BEGIN SELECT RAISE(ABORT, 'plans are append-only'); END;
CREATE TRIGGER session_trials_no_replace BEFORE INSERT ON session_trials
WHEN EXISTS (SELECT 1 FROM session_trials WHERE session_id = NEW.session_id AND trial_index = NEW.trial_index)
BEGIN SELECT RAISE(ABORT, 'plans are append-only'); END;

-- Answers, chain version 2: one chain a study, seq from 1 without gaps. row is the canonical JSON array (study, seq, session, trial_index,
-- trial_kind, shown, received_at, answer_hash, prev_hash), stored as the text that row_hash is the SHA-256 of. The first row's prev_hash is the
-- last row_hash of responses (chain version 1), or 64 zeros.
CREATE TABLE answers (
    study_id    TEXT NOT NULL,
    seq         INTEGER NOT NULL CHECK (seq >= 1),
    session_id  TEXT NOT NULL REFERENCES sessions (session_id),
    trial_index INTEGER NOT NULL CHECK (trial_index >= 0),
    row         TEXT NOT NULL,
    row_hash    TEXT NOT NULL UNIQUE CHECK (length(row_hash) = 64),
    PRIMARY KEY (study_id, seq),
    UNIQUE (session_id, trial_index),
    CHECK (json_extract(row, '$[0]') = study_id AND json_extract(row, '$[1]') = seq
           AND json_extract(row, '$[2]') = session_id AND json_extract(row, '$[3]') = trial_index)
) STRICT;
CREATE TRIGGER answers_no_update BEFORE UPDATE ON answers
BEGIN SELECT RAISE(ABORT, 'answers are append-only'); END;
CREATE TRIGGER answers_no_delete BEFORE DELETE ON answers
BEGIN SELECT RAISE(ABORT, 'answers are append-only'); END;
-- INSERT OR REPLACE deletes without firing a delete trigger: an existing key, the hidden rowid too, is refused before that, and so is a gap.
CREATE TRIGGER answers_no_replace BEFORE INSERT ON answers
WHEN EXISTS (SELECT 1 FROM answers WHERE rowid = NEW.rowid OR (study_id = NEW.study_id AND seq = NEW.seq)
             OR (session_id = NEW.session_id AND trial_index = NEW.trial_index) OR row_hash = NEW.row_hash)
BEGIN SELECT RAISE(ABORT, 'answers are append-only'); END;
CREATE TRIGGER answers_without_gaps BEFORE INSERT ON answers
WHEN NEW.seq > 1 AND NOT EXISTS (SELECT 1 FROM answers WHERE study_id = NEW.study_id AND seq = NEW.seq - 1)
BEGIN SELECT RAISE(ABORT, 'the chain of answers has no gaps'); END;

-- What was answered and all that the page sent, apart from the row: a withdrawal blanks all three together and the chain stays whole.
-- answer_hash = SHA-256(nonce, answer, line feed, payload).
CREATE TABLE answer_contents (
    study_id TEXT NOT NULL,
    seq      INTEGER NOT NULL,
    nonce    BLOB CHECK (nonce IS NULL OR length(nonce) = 16),
    answer   TEXT CHECK (answer IS NULL OR json_valid(answer)),
    payload  TEXT,
    PRIMARY KEY (study_id, seq),
    FOREIGN KEY (study_id, seq) REFERENCES answers (study_id, seq),
    CHECK ((nonce IS NULL) = (answer IS NULL) AND (nonce IS NULL) = (payload IS NULL))
) STRICT;
CREATE TRIGGER contents_only_blanked BEFORE UPDATE ON answer_contents
WHEN NEW.answer IS NOT NULL OR NEW.study_id <> OLD.study_id OR NEW.seq <> OLD.seq
BEGIN SELECT RAISE(ABORT, 'contents are append-only; a withdrawal may only blank them'); END;
CREATE TRIGGER contents_no_delete BEFORE DELETE ON answer_contents
BEGIN SELECT RAISE(ABORT, 'contents are append-only; a withdrawal may only blank them'); END;
CREATE TRIGGER contents_no_replace BEFORE INSERT ON answer_contents
WHEN EXISTS (SELECT 1 FROM answer_contents WHERE rowid = NEW.rowid OR (study_id = NEW.study_id AND seq = NEW.seq))
BEGIN SELECT RAISE(ABORT, 'contents are append-only; a withdrawal may only blank them'); END;

-- Chain version 1 is closed: its last hash is what every chain of version 2 begins with.
CREATE TRIGGER responses_closed BEFORE INSERT ON responses
BEGIN SELECT RAISE(ABORT, 'this chain is closed; answers go into the table answers'); END;

-- What is known of a row that does not verify. chain 1 is responses (seq is the response_id), chain 2 answers.
CREATE TABLE chain_notes (
    note_id    INTEGER PRIMARY KEY,
    chain      INTEGER NOT NULL CHECK (chain IN (1, 2)),
    study_id   TEXT NOT NULL,
    seq        INTEGER NOT NULL,
    note       TEXT NOT NULL CHECK (length(note) > 0),
    author     TEXT NOT NULL CHECK (length(author) > 0),
    written_at TEXT NOT NULL
) STRICT;
CREATE TRIGGER chain_notes_no_update BEFORE UPDATE ON chain_notes
BEGIN SELECT RAISE(ABORT, 'notes are append-only'); END;
CREATE TRIGGER chain_notes_no_delete BEFORE DELETE ON chain_notes
BEGIN SELECT RAISE(ABORT, 'notes are append-only'); END;
CREATE TRIGGER chain_notes_no_replace BEFORE INSERT ON chain_notes
WHEN EXISTS (SELECT 1 FROM chain_notes WHERE note_id = NEW.note_id)
BEGIN SELECT RAISE(ABORT, 'notes are append-only'); END;
