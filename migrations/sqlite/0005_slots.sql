-- Starts at constant cost: which slots of a version can come free, without a look at every session.
-- Of the slots below a version's top, those of completed participants are held for good and have no row here. Each other one has: it is held at
-- least as long as one that was seen at seen_at is, or it is free.
CREATE TABLE slots (
    study_id TEXT NOT NULL,
    version  TEXT NOT NULL,
    slot     INTEGER NOT NULL CHECK (slot >= 0),
    seen_at  TEXT NOT NULL,
    is_free  INTEGER NOT NULL CHECK (is_free IN (0, 1)),
    PRIMARY KEY (study_id, version, slot)
) STRICT, WITHOUT ROWID;
CREATE INDEX free_slots ON slots (study_id, version, slot) WHERE is_free = 1;
CREATE INDEX held_slots ON slots (study_id, version, seen_at) WHERE is_free = 0;
CREATE TABLE slot_tops (
    study_id TEXT NOT NULL,
    version  TEXT NOT NULL,
    top      INTEGER NOT NULL CHECK (top >= 0),
    PRIMARY KEY (study_id, version)
) STRICT, WITHOUT ROWID;

-- What is written to see whether anything can be, and taken away at once.
CREATE TABLE probes (probe INTEGER PRIMARY KEY) STRICT;

-- A plan that nobody has seen can be decided anew: one whose session has no consent yet. Any other is append-only as before.
DROP TRIGGER session_trials_no_delete;
CREATE TRIGGER session_trials_no_delete BEFORE DELETE ON session_trials
WHEN NOT EXISTS (SELECT 1 FROM sessions WHERE session_id = OLD.session_id AND consented_at IS NULL)
OR EXISTS (SELECT 1 FROM answers WHERE session_id = OLD.session_id)
OR EXISTS (SELECT 1 FROM responses WHERE session_id = OLD.session_id)
BEGIN SELECT RAISE(ABORT, 'plans are append-only'); END;
