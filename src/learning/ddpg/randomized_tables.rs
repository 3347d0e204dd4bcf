//! Domain randomization (Tobin et al. 2017) for training with a context: random tables, whose actual constants differ from those in the
//! context, and players with random errors.

use std::sync::Arc;

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::Action, context::Inputs, observation::Observation, observation_batch::ContextualObservation,
    paths::playable,
};
use crate::{
    game::Reward,
    learning::evaluation::CONTACT_STEPS,
    player::{Skill, perturbed_layout, re_aimed},
    statistics::normal_pair,
    table::{Layout, Table, TableDoubt, TableSampler},
};

/// Tables drawn for a run, and actual tables drawn for each of them.
const TABLES: usize = 4096;
const ACTUAL: usize = 4;

/// One in `OWN` tables is the run's own, and one in `TEXTBOOK` is drawn around `textbook`; the others are drawn around the run's own.
const OWN: usize = 8;
const TEXTBOOK: usize = 8;

/// On one in `ON_CLOTH` tables, except the run's own, balls cannot fly, as on tables that were calibrated before balls could.
const ON_CLOTH: usize = 8;

/// Range of the errors of players with errors, in multiples of an expert's; uniform in the logarithm. World-class is 1.55, a beginner 8.8.
const ERRORS: [f64; 2] = [0.5, 15.0];

/// Standard deviation of each coordinate of each ball for players with errors, m; the same as in the coach.
const PLACING: f64 = 3e-3;

/// Makes the random numbers of these tables independent of all others drawn from a run's seed.
const STREAM: u64 = 0x7665_6e75_6573;

/// The context of a shot: on which of the run's tables, and by a player with which errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Context {
    pub table: u32,
    /// The player's errors as a multiple of an expert's, 0 for none.
    pub errors: f32,
}

impl Context {
    /// Returns the same context on the run's own table.
    #[must_use]
    pub const fn on_own_table(self) -> Self {
        Self { table: self.table - self.table % OWN as u32, ..self }
    }
}

/// A nominal table, as in the context, and actual tables that it may stand for.
#[derive(Clone, Debug)]
struct RandomizedTable {
    nominal: Arc<Table>,
    /// Tables on which players with errors play. A player without errors plays on the nominal table.
    actual: Vec<Table>,
}

/// All tables of a run.
#[derive(Clone, Debug)]
pub struct RandomizedTables(Vec<RandomizedTable>);

impl RandomizedTables {
    /// Creates the tables for a run on `table`: only `table`, or with a context many tables, which depend on `table` and the seed alone.
    pub fn new(table: &Arc<Table>, inputs: Inputs, seed: u64) -> Self {
        if !inputs.context {
            return Self(vec![RandomizedTable { nominal: Arc::clone(table), actual: Vec::new() }]);
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ STREAM);
        let textbook = Table::preset("textbook").unwrap_or_default();
        let nameless = |table: &Table| Table { name: String::new(), doubt: None, ..table.clone() };
        let around = [table, &textbook].map(|table| {
            let table = nameless(table);
            TableSampler::new(&table, &TableDoubt::of(&table), 1.0)
        });
        let own = TableDoubt::of(table);
        // Without alternative rail laws: their constants are those of the run's own table and do not fit a drawn one.
        let near = TableDoubt { laws: Vec::new(), ..own.clone() };
        let mut all = Vec::with_capacity(TABLES);
        for number in 0..TABLES {
            let mut normal = || normal_pair(&mut rng)[0];
            let is_like_textbook = number % TEXTBOOK == 1;
            let nominal = match &around[usize::from(is_like_textbook)] {
                Some(sampler) if number % OWN != 0 => sampler.draw(&mut normal),
                _ => Table::clone(table),
            };
            let on_cloth = number % OWN != 0 && (number / OWN).is_multiple_of(ON_CLOTH);
            let nominal = Table { flight: nominal.flight.filter(|_| !on_cloth), ..nominal };
            let doubt = if number % OWN == 0 { &own } else { &near };
            let sampler = TableSampler::new(&nominal, doubt, 1.0);
            let actual =
                sampler.map_or_else(Vec::new, |sampler| (0..ACTUAL).map(|_| sampler.draw(&mut normal)).collect());
            all.push(RandomizedTable { nominal: Arc::new(nominal), actual });
        }
        Self(all)
    }

    /// Draws the context of a shot; the player has no errors with the probability `perfect`. Draws nothing if there is only one table.
    pub fn draw(&self, perfect: f64, rng: &mut (impl Rng + ?Sized)) -> Context {
        if self.0.len() < 2 {
            return Context::default();
        }
        let table = rng.random_range(0..self.0.len()) as u32;
        let errors = if rng.random_bool(perfect) { 0.0 } else { Self::errors(rng) };
        Context { table, errors }
    }

    /// Draws the errors of a player with errors, as a multiple of an expert's.
    pub fn errors(rng: &mut (impl Rng + ?Sized)) -> f32 {
        let [least, most] = ERRORS.map(f64::ln);
        rng.random_range(least..most).exp() as f32
    }

    /// Returns the nominal table of a context.
    pub fn table(&self, context: Context) -> &Arc<Table> {
        &self.0[context.table as usize % self.0.len()].nominal
    }

    /// Combines an observation with a context.
    pub fn contextual(&self, observation: Observation, context: Context) -> ContextualObservation {
        ContextualObservation { observation, table: Arc::clone(self.table(context)), errors: f64::from(context.errors) }
    }

    /// Simulates one attempt at the stroke of `action` and returns its reward; 0 if the cue has no room.
    pub fn attempt(
        &self,
        reward: Reward,
        layout: &Layout,
        (observation, action): (&Observation, Action),
        context: Context,
        rng: &mut (impl Rng + ?Sized),
    ) -> f64 {
        let RandomizedTable { nominal, actual } = &self.0[context.table as usize % self.0.len()];
        let Ok(cue) = playable(nominal, layout, observation, action) else { return 0.0 };
        if context.errors == 0.0 {
            return reward.of_within_steps(nominal, layout, &cue, CONTACT_STEPS);
        }
        let table = if actual.is_empty() { nominal } else { &actual[rng.random_range(0..actual.len())] };
        let mut normal = || normal_pair(rng)[0];
        let there = perturbed_layout(nominal, layout, PLACING, &mut normal);
        let cue = re_aimed(nominal, layout, &there, &cue);
        let errors = std::array::from_fn(|_| normal());
        let stroke = Skill::level(f64::from(context.errors)).stroke(table.radius, &cue, &errors);
        if stroke.is_miscue(table) { 0.0 } else { reward.of_within_steps(table, &there, &stroke, CONTACT_STEPS) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::ddpg::{action::ActionSpace, context::is_known_table};

    fn inputs(context: bool) -> Inputs {
        Inputs { space: ActionSpace::Full, context, closed_form: true, rails_first: false }
    }

    #[test]
    fn only_context_agents_train_on_many_tables() {
        let table = Arc::new(Table::default());
        let alone = RandomizedTables::new(&table, inputs(false), 1);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        assert_eq!((alone.0.len(), alone.draw(0.35, &mut rng)), (1, Context::default()));
        let [one, same, other] = [1, 1, 2].map(|seed| RandomizedTables::new(&table, inputs(true), seed));
        let nominal =
            |tables: &RandomizedTables| tables.0.iter().map(|table| Table::clone(&table.nominal)).collect::<Vec<_>>();
        assert_eq!(nominal(&one), nominal(&same));
        assert_ne!(nominal(&one), nominal(&other));
        let known = one.0.iter().filter(|table| is_known_table(&table.nominal)).count();
        assert!(known > TABLES * 9 / 10, "{known} of {TABLES}");
        assert!(one.0.iter().all(|table| table.actual.len() == ACTUAL));
        let perfect = (0..1000).filter(|_| one.draw(0.35, &mut rng).errors == 0.0).count();
        assert!((300..400).contains(&perfect), "{perfect}");
    }

    #[test]
    fn larger_errors_make_fewer_points() {
        let table = Arc::new(Table::default());
        let tables = RandomizedTables::new(&table, inputs(true), 1);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        let made = [0.0_f32, 3.0, 30.0].map(|errors| {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
            let points = (0..400).map(|_| {
                let layout = Layout::random(&table, &mut rng);
                // A rather full hit of the first ball at middle speed, which every steady player makes.
                let (observation, action) = (Observation::new(&layout, 0), [-0.2, -0.2, 0.0, 0.0, -1.0]);
                let context = Context { table: 0, errors };
                tables.attempt(Reward::R1, &layout, (&observation, action), context, &mut rng)
            });
            points.sum::<f64>()
        });
        assert!(made[0] >= made[1] && made[1] > made[2] + 20.0, "{made:?}");
        let again = tables.draw(0.35, &mut rng);
        assert!(again.errors == 0.0 || (0.5..15.0).contains(&again.errors));
    }
}
