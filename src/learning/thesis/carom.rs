//! Carom billiards as the environment of the thesis' agents: raw positions in, direction and speed out, a reward for every shot.

use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    environment::{Action, Environment, Observation, Outcome, State, direction_and_speed},
    hindsight,
};
use crate::{
    game::{Referee, Reward, Rule},
    learning::{
        evaluation::CONTACT_STEPS,
        settings::{SettingError, check},
    },
    physics::{CueInputs, has_room, strike},
    simulation::simulate,
    table::{Layout, Table},
};

/// When an episode ends. The thesis does not state it. Its mean rewards, which are below the maximum of one shot, suggest one-shot
/// episodes; its discount factor of 0.99 suggests longer ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Episode {
    /// After one shot: every shot is played on a fresh layout.
    #[default]
    OneShot,
    /// After this number of shots, each played from where the balls have stopped.
    Shots(u32),
    /// After a miss, or after this number of shots, each played from where the balls have stopped.
    UntilMiss(u32),
}

impl Episode {
    pub(super) fn validate(self) -> Result<(), SettingError> {
        match self {
            Self::OneShot => Ok(()),
            Self::Shots(most) | Self::UntilMiss(most) => check("episode", f64::from(most), most > 0, "at least 1"),
        }
    }
}

/// Rows and columns of the squares that define the discrete states of tabular Q-learning (4.2.2).
const SQUARES: [u32; 2] = [6, 12];

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CaromGame {
    pub(super) table: Table,
    reward: Reward,
    episode: Episode,
    layout: Layout,
    /// Shots played in this episode.
    shots: u32,
}

impl CaromGame {
    pub fn new(table: Table, reward: Reward, episode: Episode) -> Self {
        Self { layout: Layout::opening(&table), table, reward, episode, shots: 0 }
    }

    /// Returns the agent's observation of a layout.
    pub fn observation(&self, layout: &Layout) -> Observation {
        let reach = self.table.reach();
        let (mut state, mut cell) = ([0.0; 6], 0);
        for (position, ball) in state.chunks_exact_mut(2).zip(layout.balls) {
            position[0] = (ball.x / reach.x) as f32;
            position[1] = (ball.y / reach.y) as f32;
            // The square with the nearest centre is the one that contains the ball's centre.
            let square = |part: f64, count: u32| ((0.5 * (part + 1.0) * f64::from(count)) as u32).min(count - 1);
            let row = square(ball.y / self.table.half_width(), SQUARES[0]);
            let column = square(ball.x / self.table.half_length(), SQUARES[1]);
            cell = (cell * SQUARES[0] + row) * SQUARES[1] + column;
        }
        Observation { state, cell }
    }

    /// Returns the reward of `action` on a layout, without changing the game.
    pub fn reward_of(&self, layout: &Layout, action: Action) -> f64 {
        self.reward.of_playable(&self.table, layout, &cue_inputs(action), u32::MAX)
    }

    /// Plays the next shot of the game to its end; returns the reward and whether the shot was a miss. A stroke for which the cue has no
    /// room is not played.
    fn play_on(&mut self, action: Action) -> (f64, bool) {
        let (mut referee, cue) = (Referee::until_end(), cue_inputs(action));
        if !has_room(&self.table, &self.layout, &cue) {
            return (0.0, true);
        }
        let end = simulate(&self.table, &self.layout, &strike(&self.table, &cue), &mut referee);
        let tally = referee.tally;
        self.layout = end.layout(&self.table);
        let hit = match self.reward {
            Reward::R1 | Reward::R1Difficulty | Reward::R2 => tally.has_hit_any(),
            Reward::R4 => tally.is_point(Rule::StraightRail),
            point => point.value(&self.table, &tally, &self.layout) >= point.max_value(),
        };
        (self.reward.value(&self.table, &tally, &self.layout), !hit)
    }
}

impl Environment for CaromGame {
    fn reward_for(&self, action: Action) -> f64 {
        self.reward.of_playable(&self.table, &self.layout, &cue_inputs(action), CONTACT_STEPS)
    }

    fn hindsight_states(&self, action: Action, rng: &mut Xoshiro256PlusPlus) -> Vec<State> {
        let moved = hindsight::layouts(&self.table, self.reward, &self.layout, &cue_inputs(action), rng);
        moved.iter().map(|layout| self.observation(layout).state).collect()
    }

    fn reset(&mut self, rng: &mut Xoshiro256PlusPlus) {
        self.layout = Layout::random(&self.table, rng);
        self.shots = 0;
    }

    fn observe(&self) -> Observation {
        self.observation(&self.layout)
    }

    fn step(&mut self, action: Action) -> Outcome {
        self.shots += 1;
        match self.episode {
            // Nothing follows, so the shot need not be played to its end.
            Episode::OneShot => Outcome { reward: self.reward_of(&self.layout, action), terminated: true },
            Episode::Shots(most) => Outcome { reward: self.play_on(action).0, terminated: self.shots >= most },
            Episode::UntilMiss(most) => {
                let (reward, missed) = self.play_on(action);
                Outcome { reward, terminated: missed || self.shots >= most }
            }
        }
    }
}

/// Returns the cue inputs of an action: a shot without spin (4.1.3).
pub fn cue_inputs(action: Action) -> CueInputs {
    let [phi, speed] = direction_and_speed(action);
    CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use rand::SeedableRng;

    fn thesis() -> Table {
        Table::preset("thesis").unwrap()
    }

    #[test]
    fn cells_number_the_373_248_states_of_the_thesis() {
        let game = CaromGame::new(thesis(), Reward::R1, Episode::OneShot);
        let reach = game.table.reach();
        assert_eq!(game.observation(&Layout::new([-reach; 3])).cell, 0);
        let last = game.observation(&Layout::new([reach; 3]));
        assert_eq!(last.cell, 373_247);
        assert_eq!(last.state, [1.0; 6]);
        let moved = Layout::new([reach, reach, reach - DVec2::new(game.table.length / 12.0, 0.0)]);
        assert_eq!(game.observation(&moved).cell, 373_246);
    }

    #[test]
    fn a_game_continues_until_the_episode_ends() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut game = CaromGame::new(thesis(), Reward::R1, Episode::Shots(2));
        game.layout = Layout::opening(&game.table);
        let before = game.observe();
        // A shot straight along the table at the red ball.
        assert_eq!(game.step([0.0, 1.0]), Outcome { reward: 1.0, terminated: false });
        assert_ne!(game.observe(), before);
        assert!(game.step([0.0, 1.0]).terminated);
        game.reset(&mut rng);
        assert_eq!(game.shots, 0);

        let mut game = CaromGame::new(thesis(), Reward::R1, Episode::UntilMiss(9));
        game.layout = Layout::opening(&game.table);
        assert!(!game.step([0.0, 1.0]).terminated);
        game.layout = Layout::opening(&game.table);
        assert_eq!(game.step([1.0, -1.0]), Outcome { reward: 0.0, terminated: true });
    }

    #[test]
    fn a_single_shot_earns_the_reward_of_a_game() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        for reward in Reward::ALL {
            let mut alone = CaromGame::new(thesis(), reward, Episode::OneShot);
            let mut game = CaromGame::new(thesis(), reward, Episode::Shots(1));
            for index in 0..50u8 {
                alone.reset(&mut rng);
                game.layout = alone.layout;
                let action = [f32::from(index) / 25.0 - 1.0, 0.7];
                assert_eq!(alone.step(action).reward, game.step(action).reward, "{reward}");
            }
        }
    }
}
