-- Stimuli as browsers get them: other bytes that show the same pixels. What is packed by an older packer is packed anew.
CREATE TABLE packings (
    sha256 TEXT PRIMARY KEY REFERENCES stimuli (sha256),
    packer INTEGER NOT NULL,
    packed_sha256 TEXT NOT NULL,
    size_bytes INTEGER NOT NULL
) STRICT;
-- Pages that were loaded before each session had addresses of its own ask by hash for what they have yet to show: for a day.
ALTER TABLE stimuli ADD COLUMN open_until TEXT;
UPDATE stimuli SET open_until = strftime('%Y-%m-%dT%H:%M:%fZ', 'now', '+1 day');
