//! The reasons for a shot, in sentences.

use super::{Difference, Drawback, Kiss, NOTABLE_DIFFERENCE, Why, leads_by_plan};
use crate::{
    coach::{
        Units,
        words::{PositionUnit, capitalize, format_trimmed},
    },
    table::CueBall,
};

/// Aim tolerances that differ by less than this share of the second shot's are reported as alike.
const NOTABLE_WIDTH_SHARE: f64 = 0.05;

/// Minimum differences that are reported, of fullness and of table lengths.
const MIN_FULLNESS_DIFFERENCE: f64 = 0.06;
const MIN_LENGTHS_DIFFERENCE: f64 = 0.3;

impl Why {
    /// Describes the reasons in sentences, for a player with `cue_ball`.
    pub fn words(&self, cue_ball: CueBall, units: Units) -> String {
        let names = cue_ball.names();
        let second = self.second.as_ref();
        let made = |rate: f64| {
            let own = format!("it is made {} of the time", percent(rate));
            match second.and_then(|second| second.make_probability) {
                None => own,
                Some(its) if (rate - its).abs() > NOTABLE_DIFFERENCE => {
                    let luck = if self.is_unsure() { ", maybe by chance" } else { "" };
                    format!("{own}, the second shot {}{luck}", percent(its))
                }
                Some(its) => format!("{own}, about as often as the second shot ({})", percent(its)),
            }
        };
        let mut parts: Vec<String> = self.make_probability.map(made).into_iter().collect();
        let mut reasons = self.reasons(cue_ball, "the second shot");
        if let (Some(reason), Some(Kiss { place, .. })) = (reasons.iter_mut().find(|reason| reason.is_kiss), self.kiss)
        {
            let (diamond, middle) = self.scale;
            let [along, up] = (place + middle).to_array().map(|along| match units.position {
                PositionUnit::Diamonds => format_trimmed(along / diamond, 1),
                PositionUnit::Mm => format!("{} mm", format_trimmed(1e3 * along, 0)),
            });
            reason.words = format!("{} of the strokes, at {along} along and {up} up", reason.words);
        }
        parts.extend(with_but(reasons));
        let alone = if self.is_the_first {
            "no other shot was looked for"
        } else {
            "nothing else was found that makes the point"
        };
        parts.push(
            second.map_or_else(|| alone.to_owned(), |second| format!("the second shot is {}", second.parts(names))),
        );
        parts.iter().map(|part| format!("{}.", capitalize(part))).collect::<Vec<_>>().join(" ")
    }

    /// Whether the second-best shot has the higher make probability, and the plan explains why this one leads.
    fn is_by_plan(&self) -> bool {
        let own = (self.make_probability, self.next_probability);
        self.second
            .as_ref()
            .is_some_and(|second| leads_by_plan(own, (second.make_probability, second.next_probability)))
    }

    /// Whether the second-best shot seems to be made more often, possibly by chance.
    fn is_unsure(&self) -> bool {
        self.unsure.contains(&2)
    }

    /// Describes the probability of the next point, compared with that after the second-best shot, which is called `other`.
    fn plan_words(&self, other: &str) -> Option<String> {
        let there = self.second.as_ref().and_then(|second| second.next_probability);
        let left = self.next_probability.map(|next| {
            let is_alike = there.is_some_and(|there| (next - there).abs() < NOTABLE_DIFFERENCE);
            let as_easy = if is_alike { "about as easy, " } else { "" };
            let there = there.map_or_else(String::new, |there| format!(" (after {other}: {})", percent(there)));
            format!("it leaves the next point {as_easy}at {}{there}", percent(next))
        });
        left.map(|left| if self.is_by_plan() { format!("the plan decides: {left}") } else { left })
    }

    /// Returns short forms, for a display that already contains the make probability, and for a player with `cue_ball`. The
    /// difference from the second-best shot comes first, and the plan if it decides. The first text is complete; the
    /// second one does not call shot 2 the next best, and so on with one fact fewer.
    pub fn brief(&self, cue_ball: CueBall) -> impl Iterator<Item = String> {
        let names = cue_ball.names();
        let alone = if self.is_the_first { "no other was looked for" } else { "no other was found" };
        let second = self.second.as_ref().map_or_else(
            || alone.to_owned(),
            |second| {
                let made = second.make_probability.map_or_else(String::new, |rate| format!(": {}", percent(rate)));
                let luck = if self.is_unsure() { ", maybe by chance" } else { "" };
                format!("shot 2 ({}){made}{luck}", second.parts(names))
            },
        );
        let mut facts: Vec<String> = with_but(self.reasons(cue_ball, "shot 2")).collect();
        let first = if self.is_by_plan() { format!("{second}; {}", facts.remove(0)) } else { second };
        let role = if self.second.is_some() { "the next best is " } else { "" };
        let texts = |first: &str| shortened_texts([&[first.to_owned()], &facts[..]].concat());
        texts(&format!("{role}{first}")).zip(texts(&first)).flat_map(|(long, short)| [long, short])
    }

    /// Returns short forms without what a list of the shots with their probabilities contains, each with one fact
    /// fewer; empty if there are none.
    pub fn facts_beyond_list(&self, cue_ball: CueBall) -> impl Iterator<Item = String> {
        let luck = match &self.unsure[..] {
            [] => None,
            [number] => Some(format!("shot {number} may lead by luck")),
            [numbers @ .., last] => {
                let numbers: Vec<_> = numbers.iter().map(usize::to_string).collect();
                Some(format!("shots {} and {last} may lead by luck", numbers.join(", ")))
            }
        };
        let reasons = self.reasons(cue_ball, "shot 2");
        let lead = || {
            // Nothing but the make probability speaks for it.
            reasons.first().filter(|reason| !reason.is_for)?;
            let Some(second) = &self.second else { return Some("no other was found".to_owned()) };
            let (own, its) = self.make_probability.zip(second.make_probability)?;
            match own - its {
                more if more > NOTABLE_DIFFERENCE => Some("it is made more often than shot 2".to_owned()),
                alike if alike >= -NOTABLE_DIFFERENCE => Some("it is made about as often as shot 2".to_owned()),
                _ => None,
            }
        };
        let lead = luck.or_else(lead);
        shortened_texts(lead.into_iter().chain(with_but(reasons)).collect()).map(|sentence| capitalize(&sentence))
    }

    /// Returns what speaks for the shot, then what speaks against it, compared with the second-best shot, which is called `other`. If the
    /// plan decides, that comes first.
    fn reasons(&self, cue_ball: CueBall, other: &str) -> Vec<Reason> {
        let names = cue_ball.names();
        let second = self.second.as_ref();
        let mut reasons = Vec::new();
        reasons.extend(self.aim_deg.map(|width| {
            let own = degrees(width);
            let Some(its) = second.and_then(|second| second.aim_deg) else {
                return Reason::new(true, format!("the aim tolerance is {own} wide"));
            };
            let there = degrees(its);
            if own == there || (width - its).abs() < NOTABLE_WIDTH_SHARE * its {
                return Reason::new(true, format!("the aim tolerance is {own} wide, like that of {other}"));
            }
            let than = if width > its { "wider" } else { "narrower" };
            Reason::new(width > its, format!("the aim tolerance is {than}, {own} ({other}: {there})"))
        }));
        reasons.extend(self.kiss.map(|Kiss { share, balls: [one, other], .. }| {
            let words = format!("{} and {} kiss in {}", names[one], names[other], percent(share));
            Reason { is_kiss: true, ..Reason::new(false, words) }
        }));
        reasons.extend(second.and_then(|second| second.drawback).map(|drawback| {
            let words = match drawback {
                Drawback::HardStroke => format!("{other} needs a very hard stroke"),
                Drawback::HitsTwice => format!("{other} hits the first ball twice"),
            };
            Reason::new(true, format!("{words}, so it is less certain than its rate"))
        }));
        if let Some(plan) = self.plan_words(other) {
            let next = self.next_probability.zip(second.and_then(|second| second.next_probability));
            let is_for = self.is_by_plan() || next.is_none_or(|(after, other)| after >= other - NOTABLE_DIFFERENCE);
            let place = if self.is_by_plan() { 0 } else { reasons.len() };
            reasons.insert(place, Reason::new(is_for, plan));
        }
        reasons.sort_by_key(|reason| !reason.is_for);
        reasons
    }
}

/// A fact that speaks for the shot or against it.
struct Reason {
    is_for: bool,
    is_kiss: bool,
    words: String,
}

impl Reason {
    const fn new(is_for: bool, words: String) -> Self {
        Self { is_for, is_kiss: false, words }
    }
}

/// Returns the words of reasons; "but" precedes the first that speaks against the shot.
fn with_but(reasons: Vec<Reason>) -> impl Iterator<Item = String> {
    let first = reasons.iter().position(|reason| !reason.is_for);
    let word = move |(index, reason): (usize, Reason)| {
        if Some(index) == first { format!("but {}", reason.words) } else { reason.words }
    };
    reasons.into_iter().enumerate().map(word)
}

/// Joins the parts into a text; the first one has all parts, each further one drops the last part.
fn shortened_texts(parts: Vec<String>) -> impl Iterator<Item = String> {
    (1..=parts.len()).rev().map(move |many| format!("{}.", parts[..many].join("; ")))
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn degrees(width: f64) -> String {
    if width < 0.005 { "less than 0.01\u{b0}".to_owned() } else { format!("{}\u{b0}", format_trimmed(width, 2)) }
}

impl Difference {
    fn parts(&self, names: [&'static str; 3]) -> String {
        let pattern = self.pattern.unwrap_or("another shot");
        let mut parts = vec![if self.has_same_pattern { format!("also {pattern}") } else { pattern.to_owned() }];
        parts.extend(self.first_ball.map(|ball| format!("off {}", names[ball])));
        parts.extend(
            (self.fuller.abs() > MIN_FULLNESS_DIFFERENCE)
                .then(|| if self.fuller > 0.0 { "thicker" } else { "thinner" }.into()),
        );
        parts.extend(
            (self.harder.abs() > MIN_LENGTHS_DIFFERENCE)
                .then(|| if self.harder > 0.0 { "harder" } else { "softer" }.into()),
        );
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Coach, Request, Skill, why},
        table::{Layout, Table},
    };

    #[test]
    fn reasons_compare_the_two_best_shots() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
        let coach = Coach::without_policy(table.clone());
        let request = Request {
            skill: Skill::CLUB,
            simulations: 3000,
            budget: std::time::Duration::from_secs(60),
            ..Request::default()
        };
        let advice = coach.recommend(&layout, &request).unwrap();
        let why = why(request.shooter(), request.rule, &table, &layout, &advice, 1).unwrap();
        assert_eq!(why.make_probability, advice.make_probability.map(|rate| rate.rate));
        assert!(why.second.is_some() && !advice.alternatives.is_empty());
        let sentences: Vec<String> = why.brief(CueBall::White).collect();
        let [brief, .., least] = &sentences[..] else { panic!("{sentences:?}") };
        assert!(brief.starts_with("the next best is shot 2 ("), "{brief}");
        assert!(brief.contains("aim tolerance is ") && brief.len() < 180, "{brief}");
        assert!(least.starts_with("shot 2 (") && least.ends_with(" %.") && !least.contains("tolerance"), "{least}");
        let said = why.words(CueBall::White, Units::default());
        assert!(said.ends_with('.') && said.contains("The second shot is ") && !said.contains(';'), "{said}");
        // If the next point counts too, a shot with a lower make probability may lead.
        let second = why.second.clone().map(|second| Difference {
            make_probability: Some(0.9),
            next_probability: Some(0.31),
            ..second
        });
        let planned = Why { make_probability: Some(0.8), next_probability: Some(0.62), second, ..why.clone() };
        let reason = "the plan decides: it leaves the next point at 62 %";
        let said = planned.words(CueBall::White, Units::default());
        assert!(said.contains(&format!("{} (after the second shot: 31 %).", capitalize(reason))), "{said}");
        for sentence in planned.brief(CueBall::White) {
            assert!(sentence.contains(&format!("{reason} (after shot 2: 31 %)")), "{sentence}");
        }
        assert!(planned.facts_beyond_list(CueBall::White).all(|sentence| sentence.starts_with("The plan decides")));
        // Without a clearly easier next point, the plan decides nothing.
        for next in [None, Some(0.33)] {
            let unsure = Why { next_probability: next, unsure: vec![2], ..planned.clone() };
            let said = unsure.words(CueBall::White, Units::default());
            assert!(!said.contains("plan") && said.contains("the second shot 90 %, maybe by chance."), "{said}");
        }
        // If the second shot seems to be made more often only by chance, that is no reason against the first.
        let second = |unsure: &[usize]| {
            let second = why.second.clone().map(|second| Difference { make_probability: Some(0.54), ..second });
            Why { make_probability: Some(0.48), second, unsure: unsure.to_vec(), ..why.clone() }
        };
        let said = second(&[2]).words(CueBall::White, Units::default());
        assert!(said.contains("made 48 % of the time, the second shot 54 %, maybe by chance. "), "{said}");
        for sentence in second(&[2]).brief(CueBall::White) {
            assert!(sentence.contains("%, maybe by chance"), "{sentence}");
        }
        let first = second(&[2]).facts_beyond_list(CueBall::White).next().unwrap();
        assert!(first.starts_with("Shot 2 may lead by luck"), "{first}");
        for (unsure, words) in [(&[3][..], "Shot 3 may lead"), (&[2, 3], "Shots 2 and 3 may lead")] {
            let first = second(unsure).facts_beyond_list(CueBall::White).next().unwrap();
            assert!(first.starts_with(words), "{first}");
        }
        let said = second(&[]).words(CueBall::White, Units::default());
        assert!(said.starts_with("It is made 48 % of the time, the second shot 54 %. "), "{said}");
        let without_second = Why { second: None, ..why.clone() };
        let alone = without_second.words(CueBall::White, Units::default());
        assert!(alone.ends_with('.') && !alone.contains("second shot"), "{alone}");
        assert!(alone.ends_with("Nothing else was found that makes the point."), "{alone}");
        // What speaks against the shot comes last, after "but".
        let second = Difference { aim_deg: Some(2.0), next_probability: Some(0.3), ..second(&[]).second.unwrap() };
        let both = Why {
            aim_deg: Some(1.0),
            next_probability: Some(0.6),
            second: Some(second),
            unsure: Vec::new(),
            kiss: None,
            ..without_second.clone()
        };
        let [first, ..] = &both.facts_beyond_list(CueBall::White).collect::<Vec<_>>()[..] else { panic!("no facts") };
        assert_eq!(
            first,
            "The plan decides: it leaves the next point at 60 % (after shot 2: 30 %); but the aim tolerance is narrower, 1\u{b0} (shot 2: 2\u{b0})."
        );
        // A difference that nobody notices is none.
        for (width, is_like) in [(0.97, true), (1.03, true), (0.9, false), (1.1, false)] {
            let second = both.second.clone().map(|second| Difference { aim_deg: Some(1.0), ..second });
            let said = Why { aim_deg: Some(width), second, ..both.clone() }.words(CueBall::White, Units::default());
            assert_eq!(said.contains("wide, like that of the second shot"), is_like, "{said}");
        }
        for (after, is_for) in [(0.29, true), (0.2, false)] {
            let said = Why { next_probability: Some(after), ..both.clone() }.words(CueBall::White, Units::default());
            assert_eq!(said.contains("the second shot 54 %. It leaves the next point"), is_for, "{said}");
        }
        let against = Why { next_probability: None, ..both };
        let rates =
            [(0.7, "It is made more often than shot 2; but"), (0.55, "It is made about as often as shot 2; but")];
        for (rate, words) in rates.into_iter().chain([(0.4, "But the aim tolerance is narrower")]) {
            let first =
                Why { make_probability: Some(rate), ..against.clone() }.facts_beyond_list(CueBall::White).next();
            assert!(first.as_ref().is_some_and(|first| first.starts_with(words)), "{first:?}");
        }
        let harder = against.second.clone().map(|second| Difference { drawback: Some(Drawback::HardStroke), ..second });
        let said = Why { second: harder, ..against }.words(CueBall::White, Units::default());
        let reason =
            "The second shot needs a very hard stroke, so it is less certain than its rate. But the aim tolerance";
        assert!(said.contains(reason), "{said}");
    }
}
