//! The techniques; none knows another.

pub mod mc;
pub mod oracle;
pub mod pa;
pub mod pcss;
pub mod points;
