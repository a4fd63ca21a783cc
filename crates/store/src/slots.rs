//! The lowest free slot of a version, found at a cost that does not grow with its sessions.
//!
//! `slots` holds what may come free, and is believed only where `sessions` says the same: a row is looked at again when its time has come.

use crate::clock;
use crate::error::StoreError;
use rusqlite::{Connection, OptionalExtension, params};
use std::time::Duration;

/// A version of a study, whose slots these are.
#[derive(Clone, Copy)]
pub(crate) struct Slots<'a> {
    pub(crate) writer: &'a Connection,
    pub(crate) study_id: &'a str,
    pub(crate) version: &'a str,
    /// Who was not heard of for this long holds nothing.
    pub(crate) idle: Duration,
}

/// How long a slot is held.
enum Hold {
    Free,
    /// As long as somebody who was seen then.
    SeenAt(String),
    ForGood,
}

impl Slots<'_> {
    /// The lowest slot that no participant holds, by having completed or being active.
    pub(crate) fn lowest_free(self) -> Result<u32, StoreError> {
        self.look_at_those_in_time()?;
        let mut free = self.writer.prepare_cached(
            "SELECT min(slot) FROM slots WHERE study_id = ?1 AND version = ?2 AND is_free = 1",
        )?;
        // Somebody may have come back to a slot that was free.
        while let Some(slot) = free.query_row([self.study_id, self.version], |row| row.get(0))? {
            match self.hold(slot)? {
                Hold::Free => return Ok(slot),
                held => self.note(slot, &held)?,
            }
        }
        let mut top = self.top()?;
        loop {
            match self.hold(top)? {
                Hold::Free => return Ok(top),
                // Taken before there were these tables, or brought in from elsewhere.
                held => {
                    self.note(top, &held)?;
                    top += 1;
                    self.set_top(top)?;
                }
            }
        }
    }

    /// Notes that a participant takes a slot that [`Slots::lowest_free`] gave.
    pub(crate) fn take(self, slot: u32, now: &str) -> Result<(), StoreError> {
        self.note(slot, &Hold::SeenAt(now.to_owned()))?;
        if slot == self.top()? { self.set_top(slot + 1) } else { Ok(()) }
    }

    /// Whether a participant other than this session's holds a slot.
    pub(crate) fn is_held_beside(self, slot: u32, session_id: &str) -> Result<bool, StoreError> {
        let mut held = self.writer.prepare_cached(
            "SELECT EXISTS (SELECT 1 FROM sessions WHERE study_id = ?1 AND version = ?2 AND slot = ?3 AND session_id <> ?4
             AND kind = 'participant' AND (completed_at IS NOT NULL OR last_seen_at > ?5))",
        )?;
        let seen_after = clock::before_now(self.idle);
        let of = params![self.study_id, self.version, slot, session_id, seen_after];
        Ok(held.query_row(of, |row| row.get(0))?)
    }

    /// Looks at the slots whose holders may have been silent for too long by now.
    fn look_at_those_in_time(self) -> Result<(), StoreError> {
        let mut silent = self.writer.prepare_cached(
            "SELECT slot FROM slots WHERE study_id = ?1 AND version = ?2 AND is_free = 0 AND seen_at <= ?3",
        )?;
        let of = params![self.study_id, self.version, clock::before_now(self.idle)];
        let silent = silent.query_map(of, |row| row.get(0))?.collect::<Result<Vec<u32>, _>>()?;
        silent.into_iter().try_for_each(|slot| self.note(slot, &self.hold(slot)?))
    }

    /// How a slot is held, as the sessions themselves say.
    fn hold(self, slot: u32) -> Result<Hold, StoreError> {
        let mut sessions = self.writer.prepare_cached(
            "SELECT max(completed_at IS NOT NULL), max(last_seen_at) FROM sessions
             WHERE study_id = ?1 AND version = ?2 AND slot = ?3 AND kind = 'participant'",
        )?;
        let of = params![self.study_id, self.version, slot];
        let (completed, seen_at): (Option<bool>, Option<String>) =
            sessions.query_row(of, |row| Ok((row.get(0)?, row.get(1)?)))?;
        Ok(match seen_at {
            _ if completed == Some(true) => Hold::ForGood,
            Some(seen_at) if seen_at > clock::before_now(self.idle) => Hold::SeenAt(seen_at),
            _ => Hold::Free,
        })
    }

    fn note(self, slot: u32, hold: &Hold) -> Result<(), StoreError> {
        let of = (self.study_id, self.version, slot);
        let (seen_at, is_free) = match hold {
            Hold::ForGood => {
                let gone = "DELETE FROM slots WHERE study_id = ?1 AND version = ?2 AND slot = ?3";
                self.writer.prepare_cached(gone)?.execute(of)?;
                return Ok(());
            }
            Hold::SeenAt(seen_at) => (seen_at.as_str(), false),
            Hold::Free => ("", true),
        };
        let mut note = self.writer.prepare_cached(
            "INSERT INTO slots (study_id, version, slot, seen_at, is_free) VALUES (?1, ?2, ?3, ?4, ?5)
             ON CONFLICT (study_id, version, slot) DO UPDATE SET seen_at = excluded.seen_at, is_free = excluded.is_free",
        )?;
        note.execute(params![self.study_id, self.version, slot, seen_at, is_free])?;
        Ok(())
    }

    /// The lowest slot that nothing is known of.
    fn top(self) -> Result<u32, StoreError> {
        let mut top =
            self.writer.prepare_cached("SELECT top FROM slot_tops WHERE study_id = ?1 AND version = ?2")?;
        let top = top.query_row([self.study_id, self.version], |row| row.get(0)).optional()?;
        Ok(top.unwrap_or_default())
    }

    fn set_top(self, top: u32) -> Result<(), StoreError> {
        let mut set = self.writer.prepare_cached(
            "INSERT INTO slot_tops (study_id, version, top) VALUES (?1, ?2, ?3)
             ON CONFLICT (study_id, version) DO UPDATE SET top = excluded.top",
        )?;
        set.execute(params![self.study_id, self.version, top])?;
        Ok(())
    }
}
