//! Where in a text something stands.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A place in a file's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Character of the line, from 1.
    pub column: usize,
}

impl fmt::Display for Place {
    /// `line 3, column 5`.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Where a text's lines begin, so that finding a place takes no walk through the text: a hostile file may have a problem every few bytes.
#[derive(Debug)]
pub(crate) struct Lines {
    starts: Vec<usize>,
    /// Bytes that continue a character begun before them.
    continuing: Vec<usize>,
}

impl Lines {
    pub(crate) fn of(text: &str) -> Lines {
        let places = |wanted: fn(u8) -> bool| text.bytes().enumerate().filter(move |(_, b)| wanted(*b));
        Lines {
            starts: std::iter::once(0).chain(places(|b| b == b'\n').map(|(at, _)| at + 1)).collect(),
            continuing: places(|b| b & 0b1100_0000 == 0b1000_0000).map(|(at, _)| at).collect(),
        }
    }

    /// The place of a byte.
    pub(crate) fn place(&self, offset: usize) -> Place {
        let line = self.starts.partition_point(|start| *start <= offset);
        let start = self.starts[line - 1];
        let before = |at: usize| self.continuing.partition_point(|byte| *byte < at);
        Place { line, column: offset - start - (before(offset) - before(start)) + 1 }
    }
}
