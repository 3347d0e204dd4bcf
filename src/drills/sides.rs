//! A match of two sides: whose turn it is, the score of each side, and when the match ends.
//!
//! Both sides have the same number of innings: if the side that began reaches the distance, the other one has the
//! equalising inning, which begins from the first layout of the match, as the rules of the world federation (UMB) have
//! it. A side that reaches the distance ends its inning. If both do, the match is drawn.

use std::cmp::Ordering;

use super::{Goal, Record, Session};
use crate::{coach::Skill, table::CueBall};

/// Where a match stands between two attempts. Side 0 is the one that began.
#[derive(Clone, Copy, Debug, Default)]
struct Standing {
    /// The side at the table.
    side: usize,
    points: [u32; 2],
    /// Innings that each side has ended.
    innings: [u32; 2],
}

impl Standing {
    /// Returns where the match stands after an attempt; `distance` is the number of points that wins, 0 for none.
    fn after(mut self, made: bool, distance: u32) -> Self {
        let side = self.side;
        self.points[side] += u32::from(made);
        if !made || self.has_reached(side, distance) {
            self.innings[side] += 1;
            self.side = 1 - side;
        }
        self
    }

    const fn has_reached(&self, side: usize, distance: u32) -> bool {
        distance > 0 && self.points[side] >= distance
    }

    /// Whether the match is over with this limit of innings, 0 for none.
    fn is_over(&self, distance: u32, limit: u32) -> bool {
        let has_winner = self.has_reached(0, distance) || self.has_reached(1, distance);
        self.innings[0] == self.innings[1] && (has_winner || limit > 0 && self.innings[1] >= limit)
    }
}

impl Session {
    /// Whether two sides take turns.
    pub const fn is_match(&self) -> bool {
        matches!(self.goal, Goal::Match { .. })
    }

    /// Whether the coach plays one side.
    pub const fn is_against_coach(&self) -> bool {
        matches!(self.goal, Goal::Match { against_coach: true, .. })
    }

    /// Returns the points that win a match; 0 if only the innings count.
    const fn distance(&self) -> u32 {
        if let Goal::Match { points, .. } = self.goal { points } else { 0 }
    }

    /// Returns where the session stands before each attempt and before the next one. If it is not a match, one side
    /// stays at the table.
    fn standings(&self) -> impl Iterator<Item = Standing> {
        let advance = |now: &mut Standing, made: bool| {
            if self.is_match() {
                *now = now.after(made, self.distance());
            }
            Some(*now)
        };
        let after = self.attempts.iter().map(|attempt| attempt.made).scan(Standing::default(), advance);
        std::iter::once(Standing::default()).chain(after)
    }

    /// Returns the side that plays each attempt, and the next one.
    pub(super) fn sides(&self) -> impl Iterator<Item = usize> {
        self.standings().map(|standing| standing.side)
    }

    fn standing(&self) -> Standing {
        self.standings().last().unwrap_or_default()
    }

    pub(super) fn is_match_over(&self) -> bool {
        let Goal::Match { innings, points, .. } = self.goal else { return false };
        self.standing().is_over(points, innings)
    }

    /// Whether the next stroke begins the equalising inning, from the first layout of the match.
    pub(super) fn restarts(&self) -> bool {
        let before = self.standings().nth(self.attempts.len().wrapping_sub(1));
        self.is_equalising() && before.is_some_and(|before| before.side == 0)
    }

    /// Whether the next stroke belongs to the equalising inning.
    pub fn is_equalising(&self) -> bool {
        let now = self.standing();
        now.side == 1 && now.has_reached(0, self.distance())
    }

    fn ball_of_side(&self, side: usize) -> CueBall {
        if side == 0 { self.cue_ball } else { self.cue_ball.other() }
    }

    /// Returns the cue ball of attempt `number`, which may be the next one. In a match it changes with each inning.
    pub fn cue_ball_of(&self, number: usize) -> CueBall {
        self.ball_of_side(self.standings().nth(number).map_or(0, |standing| standing.side))
    }

    /// Returns the cue ball of the next attempt.
    pub fn next_cue_ball(&self) -> CueBall {
        self.cue_ball_of(self.attempts.len())
    }

    /// Whether attempt `number`, which may be the next one, is the coach's: the other side's in a match against it.
    fn is_coachs(&self, number: usize) -> bool {
        self.is_against_coach() && self.cue_ball_of(number) != self.cue_ball
    }

    /// Whether the next stroke is the coach's.
    pub fn is_coachs_turn(&self) -> bool {
        self.is_coachs(self.attempts.len())
    }

    /// Returns the skill with which attempt `number`, which may be the next one, is played.
    pub fn skill_of(&self, number: usize) -> Skill {
        self.coach_skill.filter(|_| self.is_coachs(number)).unwrap_or(self.skill)
    }

    /// Returns the current inning, like `inning 2 of 10` or `inning 3, to 30 points`; `None` if the session has no innings.
    pub fn inning_words(&self) -> Option<String> {
        let of = |now: u32, limit: u32| match limit {
            0 => format!("inning {now}"),
            _ => format!("inning {} of {limit}", now.min(limit)),
        };
        match self.goal {
            Goal::Game { innings } => Some(of(self.misses() as u32 + 1, innings)),
            Goal::Match { innings, points, .. } => {
                let now = self.standing();
                let number = now.innings[now.side] + u32::from(!self.is_over());
                let end = match points {
                    0 => String::new(),
                    _ if self.is_equalising() => ", the equalising one".to_owned(),
                    1 => ", to 1 point".to_owned(),
                    _ => format!(", to {points} points"),
                };
                Some(of(number, innings) + &end)
            }
            _ => None,
        }
    }

    /// Returns the name of one side of a match.
    fn side_name(&self, cue_ball: CueBall) -> &'static str {
        match self.goal {
            Goal::Match { against_coach: true, .. } if cue_ball == self.cue_ball => "you",
            Goal::Match { against_coach: true, .. } => "coach",
            _ => cue_ball.name(),
        }
    }

    /// Returns the name with the ball, like `you (white)`.
    pub fn side_words(&self, cue_ball: CueBall) -> String {
        let name = self.side_name(cue_ball);
        if name == cue_ball.name() { name.to_owned() } else { format!("{name} ({cue_ball})") }
    }

    /// Returns the points of both sides of a match, like `you 3 : 1 coach`; `None` if it is not a match.
    pub fn score_words(&self) -> Option<String> {
        if !self.is_match() {
            return None;
        }
        let [one, other] = [0, 1].map(|side| self.side_name(self.ball_of_side(side)));
        let [points, others] = self.standing().points;
        Some(format!("{one} {points} : {others} {other}"))
    }

    /// Returns the ball of the side with more points; `None` if both have as many.
    fn leading_ball(&self) -> Option<CueBall> {
        let [points, others] = self.standing().points;
        match points.cmp(&others) {
            Ordering::Greater => Some(self.ball_of_side(0)),
            Ordering::Less => Some(self.ball_of_side(1)),
            Ordering::Equal => None,
        }
    }

    /// Returns the name of the ball that has won, or `draw`; `None` if it is not a match that is over.
    pub fn winner(&self) -> Option<&'static str> {
        self.is_match_over().then(|| self.leading_ball().map_or("draw", CueBall::name))
    }

    /// Returns who has won, like `you win`; `None` if it is not a match that is over.
    pub fn winner_words(&self) -> Option<String> {
        self.is_match_over().then(|| match self.leading_ball().map(|ball| self.side_name(ball)) {
            None => "a draw".to_owned(),
            Some("you") => "you win".to_owned(),
            Some("coach") => "the coach wins".to_owned(),
            Some(ball) => format!("{ball} wins"),
        })
    }

    /// Returns the score of one side of a match.
    pub fn side_record(&self, cue_ball: CueBall) -> Record {
        let sides: Vec<usize> = self.sides().collect();
        Record::of_attempts(self, |number| self.ball_of_side(sides[number]) == cue_ball)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::Skill,
        drills::{
            Venue,
            session::tests::{exercise, session},
        },
        physics::CueInputs,
    };

    /// A match to this number of points and with this limit of innings, 0 for none.
    fn to(points: u32, innings: u32, results: &str) -> Session {
        session(Goal::Match { innings, points, against_coach: false }, results)
    }

    #[test]
    fn the_second_side_ends_the_match_by_reaching_the_distance() {
        // White makes one and misses, yellow makes three.
        assert!(!to(3, 0, "x-xx").is_over());
        let over = to(3, 0, "x-xxx");
        assert!(over.is_over() && over.exercise().is_none());
        assert_eq!(over.score_words().as_deref(), Some("white 1 : 3 yellow"));
        assert_eq!(over.winner_words().as_deref(), Some("yellow wins"));
        assert_eq!([CueBall::White, CueBall::Yellow].map(|ball| over.side_record(ball).innings), [1, 1]);
    }

    #[test]
    fn the_other_side_equalises_after_the_beginner_reaches_the_distance() {
        let begun = to(2, 0, "--xx");
        assert_eq!(
            (begun.is_over(), begun.next_cue_ball()),
            (false, CueBall::Yellow),
            "the inning ends with the point"
        );
        assert_eq!(begun.inning_words().as_deref(), Some("inning 2, the equalising one"));
        assert!(begun.is_equalising() && begun.restarts() && begun.winner_words().is_none());
        let (.., layout) = begun.position().unwrap().unwrap();
        assert_eq!(layout, begun.exercises[0].layout, "from the first layout");
        let further = to(2, 0, "--xxx");
        assert!(!further.is_over() && further.is_equalising() && !further.restarts());
        for (last, score, winner) in [
            ("-", "white 2 : 0 yellow", "white wins"),
            ("x-", "white 2 : 1 yellow", "white wins"),
            ("xx", "white 2 : 2 yellow", "a draw"),
        ] {
            let over = to(2, 0, &format!("--xx{last}"));
            assert!(over.is_over(), "{last}");
            assert_eq!((over.score_words().as_deref(), over.winner_words().as_deref()), (Some(score), Some(winner)));
            assert_eq!(over.inning_words().as_deref(), Some("inning 2, to 2 points"));
            assert_eq!([CueBall::White, CueBall::Yellow].map(|ball| over.side_record(ball).innings), [2, 2]);
        }
    }

    /// Regression test: the points of both sides seemed to be one run.
    #[test]
    fn a_run_does_not_continue_with_the_other_side() {
        let drawn = to(2, 0, "xxxx");
        let record = drawn.record();
        assert_eq!((record.innings, record.high_run, record.average), (2, 2, Some(2.0)));
        assert_eq!((to(2, 0, "xxx").current_run(), drawn.current_run(), to(2, 0, "xx").current_run()), (1, 2, 2));
    }

    #[test]
    fn a_match_to_points_also_ends_at_its_last_inning() {
        assert!(!to(9, 2, "x-xx--").is_over(), "yellow has another inning");
        let over = to(9, 2, "x-xx---");
        assert!(over.is_over());
        assert_eq!(over.inning_words().as_deref(), Some("inning 2 of 2, to 9 points"));
        assert_eq!(over.winner_words().as_deref(), Some("yellow wins"));
        // The distance is reached in the last inning: there is an equalising one all the same.
        assert!(!to(1, 1, "x").is_over() && to(1, 1, "x-").is_over() && to(1, 1, "xx").is_over());
        assert_eq!(to(0, 1, "--").winner_words().as_deref(), Some("a draw"));
        // Without a distance or a limit it goes on.
        assert!(!to(0, 0, &"x-".repeat(200)).is_over());
    }

    #[test]
    fn the_equalising_inning_begins_with_the_colours_changed() {
        let goal = Goal::Match { innings: 0, points: 1, against_coach: false };
        let mut session = Session::new(goal, Venue::Program, vec![exercise("x")], Skill::CLUB, 3);
        let moved = CueInputs { a: 0.0, b: 0.2, theta: 0.05, phi: 2.5, speed: 0.4 };
        session.play(moved, false).unwrap();
        session.attempts[0].made = true;
        let (_, start) = session.position().unwrap().unwrap();
        assert_eq!((start, session.next_cue_ball()), (session.exercises[0].layout, CueBall::Yellow));
        // Then the inning continues from where the balls stop.
        let played = session.play(moved, false).unwrap();
        assert!(!played.made && session.is_over());
    }

    #[test]
    fn the_coach_plays_its_side_with_its_own_errors() {
        let goal = Goal::Match { innings: 5, points: 0, against_coach: true };
        let mut session = Session::new(goal, Venue::Program, vec![exercise("x")], Skill::BEGINNER, 3);
        session.coach_skill = Some(Skill::PERFECT);
        let soft = CueInputs { a: 0.0, b: 0.2, theta: 0.05, phi: 2.5, speed: 0.4 };
        assert_ne!(session.play(soft, false).unwrap().stroke, soft);
        assert!(session.is_coachs_turn());
        assert_eq!([session.shooter().skill, session.shooter_of(0).skill], [Skill::PERFECT, Skill::BEGINNER]);
        assert_eq!(session.play(soft, false).unwrap().stroke, soft, "a perfect player");
        let text = serde_json::to_string(&session).unwrap();
        assert_eq!(serde_json::from_str::<Session>(&text).unwrap().coach_skill, Some(Skill::PERFECT));
        session.coach_skill = None;
        assert!(!serde_json::to_string(&session).unwrap().contains("coach_skill"), "as older versions wrote it");
        assert_eq!(session.skill_of(1), Skill::BEGINNER, "as large as the player's");
    }

    #[test]
    fn match_without_coach_keeps_its_old_format() {
        let text = r#"{"match":{"innings":10}}"#;
        let goal: Goal = serde_json::from_str(text).unwrap();
        assert_eq!(goal, Goal::Match { innings: 10, points: 0, against_coach: false });
        assert_eq!(serde_json::to_string(&goal).unwrap(), text);
    }

    #[test]
    fn match_describes_its_inning_and_score() {
        let mut played = session(Goal::Match { innings: 3, points: 0, against_coach: true }, "xx-x--");
        assert_eq!(played.inning_words().as_deref(), Some("inning 2 of 3"));
        assert_eq!(played.score_words().as_deref(), Some("you 2 : 1 coach"));
        assert!(played.is_coachs_turn() && !session(played.goal, "xx-x-").is_coachs_turn());
        played.goal = Goal::Match { innings: 0, points: 0, against_coach: false };
        assert_eq!(played.score_words().as_deref(), Some("white 2 : 1 yellow"));
        assert_eq!(played.inning_words().as_deref(), Some("inning 2"));
        assert!(session(Goal::Free, "x").score_words().is_none() && session(Goal::Free, "x").inning_words().is_none());
    }

    #[test]
    fn match_cue_ball_alternates_and_sides_score_separately() {
        // White makes two and misses, yellow misses, white makes one and misses, yellow makes two.
        let results = "xx--x-xx";
        let mut played = session(Goal::Match { innings: 3, points: 0, against_coach: false }, results);
        let balls: String = (0..8).map(|number| &played.cue_ball_of(number).name()[..1]).collect();
        assert_eq!(balls, "wwwywwyy");
        assert_eq!((played.next_cue_ball(), played.is_over()), (CueBall::Yellow, false));
        let [white, yellow] = [CueBall::White, CueBall::Yellow].map(|ball| played.side_record(ball));
        assert_eq!((white.made, white.innings, white.high_run), (3, 2, 2));
        assert_eq!((yellow.made, yellow.innings, yellow.high_run), (2, 2, 2));
        // With yellow as the first cue ball, the colours are swapped throughout.
        played.cue_ball = CueBall::Yellow;
        assert_eq!((played.cue_ball_of(0), played.side_record(CueBall::Yellow)), (CueBall::Yellow, white));
        assert!(
            session(Goal::Match { innings: 1, points: 0, against_coach: false }, "x--").is_over()
                && !session(Goal::Match { innings: 1, points: 0, against_coach: false }, "x-").is_over()
        );
        // A single player keeps the cue ball.
        let alone = session(Goal::Game { innings: 3 }, "--x");
        assert_eq!(alone.next_cue_ball(), CueBall::White);
    }

    #[test]
    fn match_continues_from_final_layout_with_other_cue_ball() {
        let mut session = Session::new(
            Goal::Match { innings: 5, points: 0, against_coach: false },
            Venue::Program,
            vec![exercise("x")],
            Skill::CLUB,
            3,
        );
        let miss = CueInputs { a: 0.0, b: 0.2, theta: 0.05, phi: 2.5, speed: 0.4 };
        let (table, before) = session.position().unwrap().unwrap();
        let played = session.play(miss, false).unwrap();
        assert!(!played.made);
        let (_, after) = session.position().unwrap().unwrap();
        assert_eq!(after, played.end.for_the_opponent());
        assert_eq!((before.balls[1], before.balls[2]), (after.balls[0], after.balls[2]), "nobody has touched them");
        after.validate(&table).unwrap();
    }
}
