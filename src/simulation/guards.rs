//! Guards: how much work a shot may take.
//!
//! Work is counted in multiplications of numbers, not in time, so that a shot is the same on every machine; 10⁹ of them take about half a
//! second. Of 10⁵ random shots on "thesis" fewer than ten come to any of these limits.

/// Multiplications for the forces on one contact where it is known what holds.
pub const HELD: u64 = 1000;

/// Multiplications in what else a step of a resting contact does.
pub const STEP: u64 = 5000;

/// Multiplications after which a step of a resting contact is given up, and with it all resting contacts of the shot: some hundred times
/// as many as most steps take.
pub const MOST_STEP: u64 = 6_000_000;

/// Multiplications after which nothing rests any more: see [`super::micro_collisions`].
pub const MOST_RESTING: u64 = 36_000_000;

/// Budget, in multiplications, once nothing rests (impacts in the air included); when it is spent the shot is ended, which is not physics:
/// what takes part in another contact stands still from then on, and the audit of the stability table misses the energy.
pub const MOST_BOUNCING: u64 = 64_000_000;

/// The same for impacts in the air alone, which micro-collisions would not spare.
pub const MOST_IN_THE_AIR: u64 = 85_000_000;

/// Multiplications in the bounce of a chatter. Where bounces lose nothing, a ball that is pressed bounces until its spin has died down;
/// fewer of them than turns of the general loop must fit into the work of resting contacts.
pub const BOUNCE: u64 = 1600;

/// Multiplications in an impact in the air.
pub const IMPACT_IN_THE_AIR: u64 = 3300;

/// Turns of the general loop after which a shot ends where it is: ends of motions, impacts, and bounces and steps of resting contacts that
/// are not told as events. This is a guard, not physics, for what repeats in the air without end; a shot takes some ten turns, and one
/// with a chatter some hundred.
pub const MOST_TURNS: u32 = 50_000;

/// The same once nothing rests any more: a micro-collision takes some of them.
pub const MOST_TURNS_BOUNCING: u32 = 250_000;
