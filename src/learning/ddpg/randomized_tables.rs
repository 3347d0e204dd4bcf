//! Domain randomization (Tobin et al. 2017) for training with a context: tables that are not quite what the agent is told, and hands
//! that err.

use std::sync::Arc;

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{action::Action, context::Inputs, observation::Observation, observation_batch::Seen, ways::playable};
use crate::{
    game::Reward,
    learning::evaluation::CONTACT_STEPS,
    player::{Skill, aimed, misplaced},
    statistics::normal_pair,
    table::{Layout, Table, TableDoubt, TableSampler},
};

/// Tables that are drawn for a run, and how many each of them may really be.
const TABLES: usize = 4096;
const REAL: usize = 4;

/// One in so many is the run's own table, and one in so many is like `textbook`; the others are drawn around the run's own.
const OWN: usize = 8;
const TEXTBOOK: usize = 8;

/// On one in so many tables, but for the run's own, balls stay on the cloth, as on tables that were calibrated before balls could fly.
const ON_CLOTH: usize = 8;

/// Between which multiples of an expert's the errors of players who err lie, the logarithms alike. World-class is 1.55, a beginner 8.8.
const ERRORS: [f64; 2] = [0.5, 15.0];

/// Standard deviation of each coordinate of each ball for players who err, m: as the coach takes it to be.
const PLACING: f64 = 3e-3;

/// Tells the random numbers of these tables from all others that are drawn from a run's seed.
const STREAM: u64 = 0x7665_6e75_6573;

/// Under which conditions a shot is played: what an agent with a context is told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    pub table: u32,
    /// The player's errors as a multiple of an expert's, 0 for none.
    pub errors: f32,
}

impl Conditions {
    /// The same on the run's own table.
    #[must_use]
    pub const fn at_home(self) -> Self {
        Self { table: self.table - self.table % OWN as u32, ..self }
    }
}

/// A table as it is told, and as it may really be.
#[derive(Clone, Debug)]
struct RandomizedTable {
    told: Arc<Table>,
    /// Where players who err play; a player without errors has no doubts either.
    real: Vec<Table>,
}

/// All tables of a run.
#[derive(Clone, Debug)]
pub struct RandomizedTables(Vec<RandomizedTable>);

impl RandomizedTables {
    /// Those for a run on `table`: it alone, or with a context many, which depend on nothing but the seed.
    pub fn new(table: &Arc<Table>, inputs: Inputs, seed: u64) -> Self {
        if !inputs.context {
            return Self(vec![RandomizedTable { told: Arc::clone(table), real: Vec::new() }]);
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ STREAM);
        let textbook = Table::preset("textbook").unwrap_or_default();
        let nameless = |table: &Table| Table { name: String::new(), doubt: None, ..table.clone() };
        let around = [table, &textbook].map(|table| {
            let table = nameless(table);
            TableSampler::new(&table, &TableDoubt::of(&table), 1.0)
        });
        let own = TableDoubt::of(table);
        // Under other laws of the rails its constants would be those of this very table.
        let near = TableDoubt { laws: Vec::new(), ..own.clone() };
        let mut all = Vec::with_capacity(TABLES);
        for number in 0..TABLES {
            let mut normal = || normal_pair(&mut rng)[0];
            let is_like_textbook = number % TEXTBOOK == 1;
            let told = match &around[usize::from(is_like_textbook)] {
                Some(sampler) if number % OWN != 0 => sampler.draw(&mut normal),
                _ => Table::clone(table),
            };
            let on_cloth = number % OWN != 0 && (number / OWN).is_multiple_of(ON_CLOTH);
            let told = Table { flight: told.flight.filter(|_| !on_cloth), ..told };
            let doubt = if number % OWN == 0 { &own } else { &near };
            let sampler = TableSampler::new(&told, doubt, 1.0);
            let real = sampler.map_or_else(Vec::new, |sampler| (0..REAL).map(|_| sampler.draw(&mut normal)).collect());
            all.push(RandomizedTable { told: Arc::new(told), real });
        }
        Self(all)
    }

    /// Conditions of a shot to come; the player has no errors with the probability `perfect`. Where there is one table, nothing is drawn.
    pub fn draw(&self, perfect: f64, rng: &mut (impl Rng + ?Sized)) -> Conditions {
        if self.0.len() < 2 {
            return Conditions::default();
        }
        let table = rng.random_range(0..self.0.len()) as u32;
        let errors = if rng.random_bool(perfect) { 0.0 } else { Self::errors(rng) };
        Conditions { table, errors }
    }

    /// The errors of a player who errs, as a multiple of an expert's.
    pub fn errors(rng: &mut (impl Rng + ?Sized)) -> f32 {
        let [least, most] = ERRORS.map(f64::ln);
        rng.random_range(least..most).exp() as f32
    }

    /// The table that is told under these conditions.
    pub fn table(&self, conditions: Conditions) -> &Arc<Table> {
        &self.0[conditions.table as usize % self.0.len()].told
    }

    /// What an agent sees of a layout under these conditions.
    pub fn seen(&self, observation: Observation, conditions: Conditions) -> Seen {
        Seen { observation, table: Arc::clone(self.table(conditions)), errors: f64::from(conditions.errors) }
    }

    /// What the stroke of `action` earns in one attempt. Where the cue has no room there is no stroke, and nothing is earned.
    pub fn attempt(
        &self,
        reward: Reward,
        layout: &Layout,
        (observation, action): (&Observation, Action),
        conditions: Conditions,
        rng: &mut (impl Rng + ?Sized),
    ) -> f64 {
        let RandomizedTable { told, real } = &self.0[conditions.table as usize % self.0.len()];
        let Ok(cue) = playable(told, layout, observation, action) else { return 0.0 };
        if conditions.errors == 0.0 {
            return reward.within(told, layout, &cue, CONTACT_STEPS);
        }
        let table = if real.is_empty() { told } else { &real[rng.random_range(0..real.len())] };
        let mut normal = || normal_pair(rng)[0];
        let there = misplaced(told, layout, PLACING, &mut normal);
        let cue = aimed(told, layout, &there, &cue);
        let errors = std::array::from_fn(|_| normal());
        let stroke = Skill::level(f64::from(conditions.errors)).stroke(table.radius, &cue, &errors);
        if stroke.is_miscue(table) { 0.0 } else { reward.within(table, &there, &stroke, CONTACT_STEPS) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::ddpg::{action::ActionSpace, context::knows};

    fn inputs(context: bool) -> Inputs {
        Inputs { space: ActionSpace::Full, context, closed_form: true, rails_first: false }
    }

    #[test]
    fn with_a_context_there_are_many_tables_that_depend_on_the_seed_alone_and_without_there_is_one() {
        let table = Arc::new(Table::default());
        let alone = RandomizedTables::new(&table, inputs(false), 1);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        assert_eq!((alone.0.len(), alone.draw(0.35, &mut rng)), (1, Conditions::default()));
        let [one, same, other] = [1, 1, 2].map(|seed| RandomizedTables::new(&table, inputs(true), seed));
        let told =
            |tables: &RandomizedTables| tables.0.iter().map(|table| Table::clone(&table.told)).collect::<Vec<_>>();
        assert_eq!(told(&one), told(&same));
        assert_ne!(told(&one), told(&other));
        let known = one.0.iter().filter(|table| knows(&table.told)).count();
        assert!(known > TABLES * 9 / 10, "{known} of {TABLES}");
        assert!(one.0.iter().all(|table| table.real.len() == REAL));
        let perfect = (0..1000).filter(|_| one.draw(0.35, &mut rng).errors == 0.0).count();
        assert!((300..400).contains(&perfect), "{perfect}");
    }

    #[test]
    fn who_errs_more_makes_fewer_points() {
        let table = Arc::new(Table::default());
        let tables = RandomizedTables::new(&table, inputs(true), 1);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        let made = [0.0_f32, 3.0, 30.0].map(|errors| {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
            let points = (0..400).map(|_| {
                let layout = Layout::random(&table, &mut rng);
                // At the first ball, rather full, at middle speed: met by everybody whose hand is steady.
                let (observation, action) = (Observation::new(&layout, 0), [-0.2, -0.2, 0.0, 0.0, -1.0]);
                let conditions = Conditions { table: 0, errors };
                tables.attempt(Reward::R1, &layout, (&observation, action), conditions, &mut rng)
            });
            points.sum::<f64>()
        });
        assert!(made[0] >= made[1] && made[1] > made[2] + 20.0, "{made:?}");
        let again = tables.draw(0.35, &mut rng);
        assert!(again.errors == 0.0 || (0.5..15.0).contains(&again.errors));
    }
}
