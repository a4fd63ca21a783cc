//! What any database behind the store must keep: append-only answers, one order, nothing acknowledged is lost.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod answers;
mod chain;
mod failing;
mod first_layout;
mod growing;
mod importing;
mod killed;
mod private;
mod properties;
mod refusing;
mod sessions;
mod setting;
mod sizes;
mod slots;
mod upgrading;
mod versions;
