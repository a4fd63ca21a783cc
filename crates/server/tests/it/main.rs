//! The server through its router: what a browser and a researcher can do, and what they cannot.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod bad_requests;
mod client;
mod front;
mod making;
mod openapi;
mod persons;
mod placeholder;
mod presenting;
mod research;
mod sizes;
mod taking_part;
mod versions;
mod weight;
