//! Holding forces of the cloth, which are eliminated from the contacts' system beforehand.

use glam::{DVec2, DVec3};

use crate::physics::contact::{ActiveSet, Friction};

/// Mode in which the cloth holds a ball.
#[derive(Clone, Copy, PartialEq)]
pub enum ClothMode {
    Slides,
    Rolls,
    Stands,
}

/// Holding modes of the cloth for one ball.
#[derive(Clone, Copy)]
pub struct Sticking {
    pub cloth: ClothMode,
    /// Whether the spin about the vertical is held at zero.
    pub spin: bool,
}

impl Sticking {
    pub fn of(set: &ActiveSet, ball: usize) -> Self {
        let cloth = match (set.cloth[ball], set.roll[ball]) {
            (Friction::Slips(_), _) => ClothMode::Slides,
            (_, Friction::Slips(_) | Friction::Filippov) => ClothMode::Rolls,
            _ => ClothMode::Stands,
        };
        Self { cloth, spin: !matches!(set.spin[ball], Friction::Slips(_)) }
    }

    /// Returns the forces against slip, against rolling and against spin that hold a ball with this motion without them.
    pub fn holding_forces(self, linear: DVec2, angular: DVec3) -> (DVec2, DVec2, f64) {
        let around = angular.truncate();
        let (cloth, roll) = match self.cloth {
            ClothMode::Slides => (DVec2::ZERO, DVec2::ZERO),
            // The slip's rate is a + z×Rα; a force at the lowest point adds 7/2 of itself.
            ClothMode::Rolls => ((linear + around.perp()) / -3.5, DVec2::ZERO),
            ClothMode::Stands => {
                let cloth = around.perp() / -2.5;
                (cloth, -(linear + cloth))
            }
        };
        (cloth, roll, if self.spin { angular.z / -2.5 } else { 0.0 })
    }

    /// Returns the remaining motion after the holding forces.
    pub fn remaining_motion(self, linear: DVec2, angular: DVec3) -> (DVec2, DVec3) {
        let around = angular.truncate();
        let spin = if self.spin { 0.0 } else { angular.z };
        match self.cloth {
            ClothMode::Slides => (linear, around.extend(spin)),
            ClothMode::Stands => (DVec2::ZERO, DVec3::new(0.0, 0.0, spin)),
            ClothMode::Rolls => {
                let force = (linear + around.perp()) / -3.5;
                (linear + force, (around - 2.5 * force.perp()).extend(spin))
            }
        }
    }
}
