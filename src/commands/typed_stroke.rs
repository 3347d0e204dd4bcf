//! A typed stroke: its five inputs, or a description in a player's words.

use super::Failure;
use crate::{
    coach::{StrokeText, StrokeTextError},
    physics::{CueError, CueInputs},
    table::{CueBall, Layout, Table},
};

/// A typed stroke.
#[derive(Clone, Copy, Debug)]
pub enum TypedStroke {
    /// Given by its inputs.
    Inputs(CueInputs),
    /// Given in words, which define a stroke only for given positions of the balls.
    Words(StrokeText),
}

impl TypedStroke {
    /// Parses `"a,b,theta,phi,V"`, or words like `"red 1/2 right, 1.5 left, 3 lengths"`.
    ///
    /// # Errors
    /// Fails if the text is not a stroke, or if an input is outside its range.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let parts = || text.split(',');
        let numbers = parts().filter(|part| part.trim().parse::<f64>().is_ok()).count();
        let has_words = text.contains(char::is_alphabetic) && 2 * numbers <= parts().count();
        if !has_words {
            return inputs(text).map(Self::Inputs);
        }
        StrokeText::parse(text).map(Self::Words).map_err(|error| match error {
            StrokeTextError::UnknownPart(_) => Failure::wrong_input(format_args!(
                "\"{text}\" is not a shot: {error}; or the inputs \"a,b,theta,phi,V\" like \"0,0.2,5,12.5,3\" (radii, degrees, m/s)"
            )),
            error => Failure::wrong_input(error),
        })
    }

    /// Returns the stroke for this layout and the player who plays with `cue_ball`.
    ///
    /// # Errors
    /// Fails if the words are incomplete, or if the stroke cannot be played.
    pub fn resolve(self, table: &Table, layout: &Layout, cue_ball: CueBall) -> Result<CueInputs, Failure> {
        match self {
            Self::Inputs(cue) => Ok(cue),
            Self::Words(said) => said.stroke(table, layout, cue_ball, None).map_err(Failure::wrong_input),
        }
    }
}

/// Parses the inputs of a stroke. An error repeats the number as it was typed, because validation uses radians and squared offsets, which
/// may not be finite.
fn inputs(text: &str) -> Result<CueInputs, Failure> {
    let cue = CueInputs::parse(text).map_err(Failure::wrong_input)?;
    cue.validate().map_err(|error| {
        let (name, accepted) = match error {
            CueError::Range { name, accepted, .. } => (name, accepted),
            CueError::Tip { a, offset, .. } if !offset.is_finite() => {
                (if (a * a).is_finite() { "b" } else { "a" }, "-1 to 1 ball radii")
            }
            error => return Failure::wrong_input(error),
        };
        let typed = ["a", "b", "theta", "phi", "V"].into_iter().zip(text.split(','));
        let value = typed.into_iter().find(|(input, _)| *input == name).map_or("", |(_, value)| value.trim());
        Failure::wrong_input(format_args!("{name} = {value} is outside its range; accepted is {accepted}"))
    })?;
    Ok(cue)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> String {
        TypedStroke::parse(text).unwrap_err().to_string()
    }

    #[test]
    fn refused_strokes_are_quoted_as_typed() {
        let outside = |value: &str| format!("{value} is outside its range; accepted is ");
        for (text, value) in [
            ("0,0,0,1e6,3", "phi = 1e6"),
            ("0,0,0,1e400,3", "phi = 1e400"),
            ("0,0, 90 ,0,3", "theta = 90"),
            ("0,0,0,0,1e9", "V = 1e9"),
            ("nan,0,0,0,3", "a = nan"),
            ("0,-inf,0,0,3", "b = -inf"),
            ("1e200,0,0,0,3", "a = 1e200"),
        ] {
            assert!(said(text).starts_with(&outside(value)), "{}", said(text));
        }
        assert!(said("0.9,0.9,0,0,3").contains("misses the ball"));
        assert!(["0,0,0", "0,0,fast,0,3", "", ",,,"].iter().all(|text| said(text).contains("is not a shot")));
        assert!(matches!(TypedStroke::parse("0,0.2,5,12.5,3"), Ok(TypedStroke::Inputs(_))));
    }

    #[test]
    fn words_are_resolved_for_the_layout() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 6d,3d 6d,1d", &table).unwrap();
        let on = |text: &str, cue_ball| TypedStroke::parse(text).unwrap().resolve(&table, &layout, cue_ball);
        let cue = on("yellow full, 3 lengths", CueBall::White).unwrap();
        assert_eq!(cue, on("white full, 3 lengths", CueBall::Yellow).unwrap());
        assert!((cue.phi - (layout.balls[1] - layout.balls[0]).to_angle()).abs() < 1e-3);
        assert!(on("yellow full, soft", CueBall::Yellow).unwrap_err().to_string().contains("yellow is the cue ball"));
        assert!(said("hit it").contains("a,b,theta,phi,V") && said("hit it").contains("red 1/2 right"));
    }
}
