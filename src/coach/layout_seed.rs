//! Random seeds that differ from layout to layout, so that luck on one layout does not repeat on another.

use crate::table::Layout;

/// Returns the seed for the layout with this number.
pub const fn layout_seed(seed: u64, number: u32) -> u64 {
    seed ^ ((number as u64) << 32)
}

/// Returns a number that identifies a layout: the Fowler–Noll–Vo hash (FNV-1a) of the ball positions. Equal layouts
/// have equal numbers.
pub fn layout_number(layout: &Layout) -> u32 {
    // Maps -0 to +0.
    let positions = layout.balls.iter().flat_map(|position| [position.x + 0.0, position.y + 0.0]);
    let bytes = positions.flat_map(|position| position.to_bits().to_le_bytes());
    bytes.fold(0x811c_9dc5, |hash: u32, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn layouts_have_distinct_numbers_and_seeds() {
        let at = |x: f64| Layout::new([DVec2::new(x, 0.0), DVec2::new(0.5, 0.0), DVec2::new(1.0, 0.5)]);
        let seed = |x: f64| layout_seed(7, layout_number(&at(x)));
        assert_eq!(seed(0.0), seed(-0.0));
        assert_ne!(seed(0.0), seed(1e-9));
        assert_ne!(seed(0.0), layout_seed(8, layout_number(&at(0.0))));
    }
}
