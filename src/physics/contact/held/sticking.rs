//! What the cloth does to a ball that a force would move: it is taken out of the contacts' system beforehand.

use glam::{DVec2, DVec3};

use crate::physics::contact::{ActiveSet, Friction};

/// How the cloth holds a ball.
#[derive(Clone, Copy, PartialEq)]
pub enum Cloth {
    Slides,
    Rolls,
    Stands,
}

/// The cloth's forces on a ball that it holds: against slip, against rolling, against spin.
pub type Holding = (DVec2, DVec2, f64);

/// What the cloth does to a ball that would move otherwise.
#[derive(Clone, Copy)]
pub struct Sticking {
    pub cloth: Cloth,
    /// Whether the spin about the vertical is held.
    pub spin: bool,
}

impl Sticking {
    pub fn of(set: &ActiveSet, ball: usize) -> Self {
        let cloth = match (set.cloth[ball], set.roll[ball]) {
            (Friction::Slips(_), _) => Cloth::Slides,
            (_, Friction::Slips(_) | Friction::Eases) => Cloth::Rolls,
            _ => Cloth::Stands,
        };
        Self { cloth, spin: !matches!(set.spin[ball], Friction::Slips(_)) }
    }

    /// The forces that hold a ball which would move like this without them.
    pub fn holding(self, linear: DVec2, angular: DVec3) -> Holding {
        let around = angular.truncate();
        let (cloth, roll) = match self.cloth {
            Cloth::Slides => (DVec2::ZERO, DVec2::ZERO),
            // The slip's rate is a + z×Rα, and a force at the lowest point adds 7/2 of itself.
            Cloth::Rolls => ((linear + around.perp()) / -3.5, DVec2::ZERO),
            Cloth::Stands => {
                let cloth = around.perp() / -2.5;
                (cloth, -(linear + cloth))
            }
        };
        (cloth, roll, if self.spin { angular.z / -2.5 } else { 0.0 })
    }

    /// The movement that is left.
    pub fn held(self, linear: DVec2, angular: DVec3) -> (DVec2, DVec3) {
        let around = angular.truncate();
        let spin = if self.spin { 0.0 } else { angular.z };
        match self.cloth {
            Cloth::Slides => (linear, around.extend(spin)),
            Cloth::Stands => (DVec2::ZERO, DVec3::new(0.0, 0.0, spin)),
            Cloth::Rolls => {
                let force = (linear + around.perp()) / -3.5;
                (linear + force, (around - 2.5 * force.perp()).extend(spin))
            }
        }
    }
}
