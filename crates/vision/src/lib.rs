//! kelir-vision
