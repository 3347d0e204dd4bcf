//! The four cushions, their names and normals.

use glam::DVec2;
use serde::Serialize;

/// One of the four cushions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rail {
    /// The short cushion at `-L/2`.
    Left,
    /// The short cushion at `+L/2`.
    Right,
    /// The long cushion at `-l/2`.
    Bottom,
    /// The long cushion at `+l/2`.
    Top,
}

impl Rail {
    /// All four, in a fixed order.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Bottom, Self::Top];

    /// Returns the name used in JSON and on the screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
            Self::Top => "top",
        }
    }

    /// Returns the unit vector from the cushion into the table.
    pub const fn normal(self) -> DVec2 {
        match self {
            Self::Left => DVec2::X,
            Self::Right => DVec2::NEG_X,
            Self::Bottom => DVec2::Y,
            Self::Top => DVec2::NEG_Y,
        }
    }

    /// Returns the distance of a ball at `place` from this cushion, m. `reach` is the corner of the rectangle that ball centres can reach, m.
    pub fn gap(self, reach: DVec2, place: DVec2) -> f64 {
        let n = self.normal();
        n.abs().dot(reach) + place.dot(n)
    }

    /// Returns the mirror image of `place` in this cushion. A ball aimed at the image hits `place` off the cushion, if the rebound is a
    /// perfect reflection. `reach` is the corner of the rectangle that ball centres can reach, m.
    pub fn image(self, reach: DVec2, place: DVec2) -> DVec2 {
        let n = self.normal();
        place - 2.0 * n.dot(place) * n - 2.0 * n.abs().dot(reach) * n
    }

    /// Returns the cushion whose normal into the table is `n`, which must be one of the four normals.
    pub fn with_normal(n: DVec2) -> Self {
        Self::ALL.into_iter().find(|rail| rail.normal() == n).unwrap_or(Self::Left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_image_is_equally_far_behind_the_cushion() {
        let (reach, place) = (DVec2::new(1.4, 0.7), DVec2::new(0.3, -0.2));
        let images = Rail::ALL.map(|rail| rail.image(reach, place));
        let expected = [(-2.8 - 0.3, -0.2), (2.8 - 0.3, -0.2), (0.3, -1.4 + 0.2), (0.3, 1.4 + 0.2)];
        assert_eq!(images, expected.map(DVec2::from));
    }
}
