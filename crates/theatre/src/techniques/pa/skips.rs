//! What PA leaves out where the scene does not need it.

/// A set of things to leave out; whatever is in it, the pixels are the same to the byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skips(u8);

impl Skips {
    /// Compute everything.
    pub const NONE: Self = Self(0);
    /// Tiles outside every penumbra's bound: the lit screen's kept codes are copied.
    pub const LIT_TILES: Self = Self(1);
    /// Tiles where every emitter is hidden and there is no other light: black.
    pub const DARK_TILES: Self = Self(1 << 1);
    /// Boxes that see one transmittance, in tiles where others see more.
    pub const KNOWN_BOXES: Self = Self(1 << 2);
    /// Emitters of no radiance, where nobody asks for their visibility.
    pub const DARK_EMITTERS: Self = Self(1 << 3);
    /// Puppets that no light passes on its way to the screen.
    pub const OFF_BEAM: Self = Self(1 << 4);
    /// Second and third channels of grey puppets beside coloured ones.
    pub const GREY_CHANNELS: Self = Self(1 << 5);
    /// Tables of masks that the last frame had too.
    pub const KEPT_TABLES: Self = Self(1 << 6);
    /// The lit screen (and the dome's maps) of a lamp that did not move.
    pub const KEPT_SCREEN: Self = Self(1 << 7);
    /// Leave out whatever can be left out.
    pub const ALL: Self = Self(u8::MAX);

    /// Each skip alone, with its name and the count in [`kelir_frame::Stats`] that says how often it was of use.
    pub const EACH: [(Self, &'static str, &'static str); 8] = [
        (Self::LIT_TILES, "wholly lit tiles", "pixels_lit_copied"),
        (Self::DARK_TILES, "wholly dark tiles", "pixels_dark"),
        (Self::KNOWN_BOXES, "boxes of one transmittance", "boxes_known"),
        (Self::DARK_EMITTERS, "emitters of no radiance", "emitters_dark"),
        (Self::OFF_BEAM, "puppets off the beam", "planes_off_beam"),
        (Self::GREY_CHANNELS, "channels of grey puppets", "boxes_shared"),
        (Self::KEPT_TABLES, "tables of unmoved planes", "tables_reused"),
        (Self::KEPT_SCREEN, "the lit screen", "background_reused"),
    ];

    /// Whether any of `of` is in the set.
    pub fn has(self, of: Self) -> bool {
        self.0 & of.0 != 0
    }

    /// The set without `of`.
    pub fn without(self, of: Self) -> Self {
        Self(self.0 & !of.0)
    }
}
