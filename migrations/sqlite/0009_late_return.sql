-- A plan of which nothing has been answered can be decided anew, also after consent: whoever comes back to a place in the design that somebody
-- else has got meanwhile takes another one. Any other plan is append-only as before.
DROP TRIGGER session_trials_no_delete;
CREATE TRIGGER session_trials_no_delete BEFORE DELETE ON session_trials
WHEN NOT EXISTS (SELECT 1 FROM sessions WHERE session_id = OLD.session_id AND completed_at IS NULL)
OR EXISTS (SELECT 1 FROM answers WHERE session_id = OLD.session_id)
OR EXISTS (SELECT 1 FROM responses WHERE session_id = OLD.session_id)
BEGIN SELECT RAISE(ABORT, 'plans are append-only'); END;
