//! What any database behind the store must keep: append-only answers, one order, nothing acknowledged is lost.
#![allow(clippy::unwrap_used)]

mod answers;
mod chain;
mod first_layout;
mod growing;
mod importing;
mod killed;
mod properties;
mod refusing;
mod sessions;
mod setting;
mod upgrading;
mod versions;
