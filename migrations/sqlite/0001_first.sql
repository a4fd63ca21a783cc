-- Times are ISO-8601 UTC text of fixed width (2026-11-22T10:30:00.000Z), so that they sort as text. Hashes are 64 hex digits.

CREATE TABLE studies (
    study_id    TEXT NOT NULL,
    config_hash TEXT NOT NULL,
    config      TEXT NOT NULL CHECK (json_valid(config)),
    loaded_at   TEXT NOT NULL,
    PRIMARY KEY (study_id, config_hash)
) STRICT;

-- What was made once and is served as it is; the bytes lie beside the database, in stimuli/<first two digits>/<sha256>.
CREATE TABLE stimuli (
    sha256     TEXT PRIMARY KEY CHECK (length(sha256) = 64),
    media_type TEXT NOT NULL,
    size_bytes INTEGER NOT NULL,
    created_at TEXT NOT NULL
) STRICT;

-- Which stimulus came of which job; the key is a hash over all that went into it.
CREATE TABLE renders (
    job_key    TEXT PRIMARY KEY,
    sha256     TEXT NOT NULL REFERENCES stimuli (sha256),
    provenance TEXT NOT NULL CHECK (json_valid(provenance)),
    created_at TEXT NOT NULL
) STRICT;

-- What a study's pairs show under each condition, as last made.
CREATE TABLE study_stimuli (
    study_id    TEXT NOT NULL,
    config_hash TEXT NOT NULL,
    pair_id     TEXT NOT NULL,
    condition   TEXT NOT NULL,
    job_key     TEXT NOT NULL REFERENCES renders (job_key),
    PRIMARY KEY (study_id, config_hash, pair_id, condition),
    FOREIGN KEY (study_id, config_hash) REFERENCES studies (study_id, config_hash)
) STRICT;

CREATE TABLE sessions (
    session_id      TEXT PRIMARY KEY,
    study_id        TEXT NOT NULL,
    config_hash     TEXT NOT NULL,
    subject_id      TEXT NOT NULL,
    token_hash      TEXT NOT NULL,
    slot            INTEGER NOT NULL CHECK (slot >= 0),
    plan_seed       TEXT NOT NULL,
    trials          TEXT NOT NULL CHECK (json_valid(trials)),
    trial_count     INTEGER NOT NULL CHECK (trial_count > 0),
    params          TEXT NOT NULL CHECK (json_valid(params)),
    display         TEXT NOT NULL CHECK (json_valid(display)),
    created_at      TEXT NOT NULL,
    last_seen_at    TEXT NOT NULL,
    consented_at    TEXT,
    completed_at    TEXT,
    completion_code TEXT,
    CHECK ((completed_at IS NULL) = (completion_code IS NULL)),
    FOREIGN KEY (study_id, config_hash) REFERENCES studies (study_id, config_hash)
) STRICT;
CREATE INDEX sessions_by_study ON sessions (study_id, config_hash, slot);

-- One row a trial, appended and never changed. row_hash covers the row, payload_hash and the previous row's hash.
CREATE TABLE responses (
    response_id      INTEGER PRIMARY KEY,
    session_id       TEXT NOT NULL REFERENCES sessions (session_id),
    trial_index      INTEGER NOT NULL CHECK (trial_index >= 0),
    block_id         TEXT NOT NULL,
    pair_id          TEXT NOT NULL,
    left_sha256      TEXT NOT NULL REFERENCES stimuli (sha256),
    right_sha256     TEXT NOT NULL REFERENCES stimuli (sha256),
    left_condition   TEXT NOT NULL,
    right_condition  TEXT NOT NULL,
    choice           TEXT NOT NULL CHECK (choice IN ('left', 'right')),
    chosen_condition TEXT NOT NULL CHECK (chosen_condition = CASE choice WHEN 'left' THEN left_condition ELSE right_condition END),
    rt_ms            REAL NOT NULL CHECK (rt_ms >= 0),
    received_at      TEXT NOT NULL,
    payload_hash     TEXT NOT NULL,
    prev_hash        TEXT NOT NULL,
    row_hash         TEXT NOT NULL UNIQUE,
    UNIQUE (session_id, trial_index)
) STRICT;

-- What the browser sent with the answer, apart from the row, so that a withdrawal can blank it without touching the chain.
CREATE TABLE response_payloads (
    response_id INTEGER PRIMARY KEY REFERENCES responses (response_id),
    payload     TEXT CHECK (payload IS NULL OR json_valid(payload))
) STRICT;

CREATE TRIGGER responses_no_update BEFORE UPDATE ON responses
BEGIN SELECT RAISE(ABORT, 'responses are append-only'); END;
CREATE TRIGGER responses_no_delete BEFORE DELETE ON responses
BEGIN SELECT RAISE(ABORT, 'responses are append-only'); END;
-- INSERT OR REPLACE deletes without firing a delete trigger: an existing key is refused before that.
CREATE TRIGGER responses_no_replace BEFORE INSERT ON responses
WHEN EXISTS (SELECT 1 FROM responses WHERE response_id = NEW.response_id
             OR (session_id = NEW.session_id AND trial_index = NEW.trial_index) OR row_hash = NEW.row_hash)
BEGIN SELECT RAISE(ABORT, 'responses are append-only'); END;

CREATE TRIGGER payloads_only_blanked BEFORE UPDATE ON response_payloads
WHEN NEW.payload IS NOT NULL OR NEW.response_id <> OLD.response_id
BEGIN SELECT RAISE(ABORT, 'payloads are append-only; a withdrawal may only blank them'); END;
CREATE TRIGGER payloads_no_delete BEFORE DELETE ON response_payloads
BEGIN SELECT RAISE(ABORT, 'payloads are append-only; a withdrawal may only blank them'); END;
CREATE TRIGGER payloads_no_replace BEFORE INSERT ON response_payloads
WHEN EXISTS (SELECT 1 FROM response_payloads WHERE response_id = NEW.response_id)
BEGIN SELECT RAISE(ABORT, 'payloads are append-only; a withdrawal may only blank them'); END;

CREATE TABLE researchers (
    name          TEXT PRIMARY KEY,
    password_hash TEXT NOT NULL,
    changed_at    TEXT NOT NULL
) STRICT;

CREATE TABLE researcher_sessions (
    token_hash TEXT PRIMARY KEY,
    name       TEXT NOT NULL REFERENCES researchers (name) ON DELETE CASCADE,
    created_at TEXT NOT NULL,
    expires_at TEXT NOT NULL
) STRICT;
