-- A version shows each item under each condition at each of its study's sizes: the size is part of the key. What was stored has one.
CREATE TABLE version_stimuli_of_sizes (
    study_id      TEXT NOT NULL,
    version       TEXT NOT NULL,
    item_id       TEXT NOT NULL,
    condition     TEXT NOT NULL,
    width         INTEGER NOT NULL CHECK (width >= 0),
    height        INTEGER NOT NULL CHECK (height >= 0),
    sha256        TEXT NOT NULL REFERENCES stimuli (sha256),
    pixels_sha256 TEXT NOT NULL,
    provenance    TEXT NOT NULL CHECK (json_valid(provenance)),
    PRIMARY KEY (study_id, version, item_id, condition, width, height),
    FOREIGN KEY (study_id, version) REFERENCES versions (study_id, version)
) STRICT, WITHOUT ROWID;
-- Of a stimulus whose file was gone when sizes were first noted the size is not known: 0.
INSERT INTO version_stimuli_of_sizes
SELECT v.study_id, v.version, v.item_id, v.condition, coalesce(s.width, 0), coalesce(s.height, 0), v.sha256, v.pixels_sha256, v.provenance
FROM version_stimuli v JOIN stimuli s USING (sha256);
DROP TABLE version_stimuli;
ALTER TABLE version_stimuli_of_sizes RENAME TO version_stimuli;
CREATE TRIGGER version_stimuli_no_update BEFORE UPDATE ON version_stimuli
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
CREATE TRIGGER version_stimuli_no_delete BEFORE DELETE ON version_stimuli
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
CREATE TRIGGER version_stimuli_no_replace BEFORE INSERT ON version_stimuli
WHEN EXISTS (SELECT 1 FROM version_stimuli WHERE study_id = NEW.study_id AND version = NEW.version
             AND item_id = NEW.item_id AND condition = NEW.condition AND width = NEW.width AND height = NEW.height)
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
-- What a version shows is complete when its first session begins.
CREATE TRIGGER version_stimuli_complete BEFORE INSERT ON version_stimuli
WHEN EXISTS (SELECT 1 FROM sessions WHERE study_id = NEW.study_id AND version = NEW.version)
BEGIN SELECT RAISE(ABORT, 'what a version shows never changes'); END;
