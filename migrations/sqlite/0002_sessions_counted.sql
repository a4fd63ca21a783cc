-- Counting sessions and finding a free slot read this index alone: in the table, the times lie behind each session's whole plan.
DROP INDEX sessions_by_study;
CREATE INDEX sessions_by_study ON sessions (study_id, config_hash, slot, completed_at, last_seen_at);
