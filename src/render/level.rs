//! How finely the fields of a scene are worked out.

/// How finely.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// For the first, coarse passes of a window: in milliseconds.
    Coarse,
    /// For every pixel of a picture.
    Fine,
}
