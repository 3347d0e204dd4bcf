//! Parser for typed positions of one or more balls, with or without colours.

use super::{
    BALLS, CueBall, Layout, LayoutError, Table,
    layout::{Coordinate, coordinates, position_of},
};

/// Why the typed text is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum PositionsError {
    /// A word is neither a position nor the name of a ball.
    #[error(
        "\"{0}\" is not a position; write x,y in diamonds from the lower left corner like 2d,0.5d, or in mm, cm, m, in or ft from the \
         middle like 20cm,-5cm, optionally after a colour"
    )]
    Word(String),
    /// A ball is named, but no position follows.
    #[error("where is {0}? write x,y after it, each number with its unit, like \"{0} 2d,0.5d\" or \"{0} 20cm,-5cm\"")]
    Missing(&'static str),
    /// Nothing was typed.
    #[error(
        "where is the ball? write one place like 2d,0.5d, for the selected ball, or three: cue ball, the other, red"
    )]
    Empty,
    /// A ball has two positions.
    #[error("{0} is put in two places; name each ball once")]
    Twice(&'static str),
    /// Several positions without colours, but not three.
    #[error(
        "{0} places without a colour; write one like 2d,0.5d, for the selected ball, or three: cue ball, the other, red"
    )]
    Count(usize),
    /// Some positions have a colour and others have none.
    #[error("some positions have a colour and some have none; write one before each, or before none")]
    Mixed,
    /// A position in diamonds lies outside the table.
    #[error(
        "{name} at {x:.2}d,{y:.2}d is outside the table; accepted are {least:.2}d to {along:.2}d, and {least:.2}d to {up:.2}d; \
         nearer to a rail the ball touches it"
    )]
    Outside {
        /// The ball's name.
        name: &'static str,
        /// Coordinate along the table, diamonds.
        x: f64,
        /// Coordinate across the table, diamonds.
        y: f64,
        /// Smallest accepted value of both coordinates, diamonds.
        least: f64,
        /// Largest accepted value along the table, diamonds.
        along: f64,
        /// Largest accepted value across the table, diamonds.
        up: f64,
    },
    /// The layout is not possible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
}

impl Layout {
    /// Returns the layout with the positions in `text`:
    /// - `2d,0.5d` moves the ball `selected`;
    /// - `2d,0.5d 6d,2d 4d,3.5d` moves the cue ball, the opponent's ball and the red ball;
    /// - `red 4d,3.5d` moves the ball of that colour for a player with `cue_ball`.
    ///
    /// All other balls stay. Commas between the numbers may be missing, and decimal commas are accepted. `d` stands for diamonds from the
    /// lower left corner; `mm`, `cm`, `m`, `in` and `ft` are lengths from the middle. Numbers without a unit are diamonds, but metres from
    /// the middle if one of them is negative.
    ///
    /// # Errors
    /// [`PositionsError`], also if the layout is not possible on `table`.
    pub fn with_positions(
        &self,
        text: &str,
        table: &Table,
        cue_ball: CueBall,
        selected: usize,
    ) -> Result<Self, PositionsError> {
        let names = cue_ball.names();
        let words: Vec<&str> =
            text.split([' ', '\t', '\n', '\r', ';']).filter(|word| !matches!(*word, "" | ",")).collect();
        let unknown = |word: &str| PositionsError::Word(word.to_owned());
        // The numbers of each ball; the first entry has those without a colour.
        let mut typed: Vec<(Option<usize>, Vec<Coordinate>)> = vec![(None, Vec::new())];
        for word in &words {
            match names.iter().position(|name| matches_name(name, word)) {
                Some(ball) if typed.iter().any(|(other, _)| *other == Some(ball)) => {
                    return Err(PositionsError::Twice(names[ball]));
                }
                Some(ball) => typed.push((Some(ball), Vec::new())),
                None => {
                    let more = coordinates(word).ok_or_else(|| unknown(word))?;
                    typed.last_mut().into_iter().for_each(|(_, numbers)| numbers.extend_from_slice(&more));
                }
            }
        }
        let bare = typed.remove(0).1;
        let places: Vec<(usize, &[Coordinate])> = match (typed.len(), bare.len()) {
            (0, 2) => vec![(selected, &bare[..])],
            (0, 6) => bare.chunks(2).enumerate().collect(),
            (0, 0) => return Err(PositionsError::Empty),
            (0, count) if count % 2 == 0 => return Err(PositionsError::Count(count / 2)),
            (0, _) => return Err(unknown(words.last().copied().unwrap_or_default())),
            (_, 0) => typed.iter().filter_map(|(ball, numbers)| Some(((*ball)?, &numbers[..]))).collect(),
            _ => return Err(PositionsError::Mixed),
        };
        let mut all = places.iter().flat_map(|(_, numbers)| numbers.iter());
        let is_in_metres = all.any(|number| matches!(number, Coordinate::Bare(number) if *number < 0.0));
        let with_unit = |number: Coordinate| match number {
            Coordinate::Bare(number) if !is_in_metres => Coordinate::Diamonds(number),
            number => number,
        };
        let mut layout = *self;
        let mut in_diamonds = [false; BALLS];
        for (ball, numbers) in &places {
            let [x, y] = numbers[..] else {
                return Err(if numbers.len() < 2 {
                    PositionsError::Missing(names[*ball])
                } else {
                    PositionsError::Mixed
                });
            };
            if matches!(x, Coordinate::Bare(_)) != matches!(y, Coordinate::Bare(_)) {
                return Err(unknown(text.trim()));
            }
            let [x, y] = [x, y].map(with_unit);
            layout.balls[*ball] = position_of(x, y, table).ok_or_else(|| unknown(text.trim()))?;
            in_diamonds[*ball] = matches!(x, Coordinate::Diamonds(_));
        }
        layout.validate(table).map_err(|error| match error {
            LayoutError::Outside { ball, x, y, max_x, max_y } if in_diamonds[ball] => {
                let [x, least, along] = [x, -max_x, max_x].map(|x| (0.5 * table.length + x) / table.diamond());
                let [y, up] = [y, max_y].map(|y| (0.5 * table.width + y) / table.diamond());
                PositionsError::Outside { name: names[ball], x, y, least, along, up }
            }
            error => error.for_player(cue_ball).into(),
        })?;
        Ok(layout)
    }
}

/// Whether `word` is the name of a ball or its first letter, in upper or lower case, with or without a colon.
fn matches_name(name: &str, word: &str) -> bool {
    let word = word.trim_end_matches([':', '=']);
    word.eq_ignore_ascii_case(name) || word.eq_ignore_ascii_case(&name[..1])
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    fn typed(text: &str) -> Result<Layout, String> {
        let table = Table::default();
        Layout::opening(&table).with_positions(text, &table, CueBall::Yellow, 2).map_err(|error| error.to_string())
    }

    #[test]
    fn typed_positions_move_one_some_or_all_balls() {
        let table = Table::default();
        let opening = Layout::opening(&table);
        let all = Layout::parse("2d,0.5d 6d,2d 4d,3.5d", &table).unwrap();
        assert_eq!(typed("2d,0.5d 6d,2d 4d,3.5d"), Ok(all));
        assert_eq!(typed(" 2d,0.5d\n6d,2d;4d,3.5d "), Ok(all), "as it is pasted");
        let [_, _, red] = all.balls;
        assert_eq!(typed("4d,3.5d").unwrap().balls, [opening.balls[0], opening.balls[1], red]);
        assert_eq!(typed("4d,3.5d"), typed("Red: 4d,3.5d"));
        // Yellow is the cue ball here.
        assert_eq!(typed("w 6d,2d y 2d,0.5d red 4d,3.5d"), Ok(all));
        assert_eq!(typed("-0.71,-0.5325").unwrap().balls[2], all.balls[0]);
    }

    #[test]
    fn commas_are_optional_or_decimal_and_numbers_without_a_unit_are_diamonds() {
        let all = typed("2d,0.5d 6d,2d 4d,3.5d");
        for same in [
            "2d 0.5d 6d 2d 4d 3.5d",
            "2d, 0,5d; 6d, 2d; 4d, 3,5d",
            "2d,0,5d 6d,2d 4d,3,5d",
            "2d , 0.5d 6d , 2d 4d , 3.5d",
            "2,0.5 6,2 4,3.5",
            "2 0.5 6 2 4 3.5",
        ] {
            assert_eq!(typed(same), all, "{same}");
        }
        assert!(typed("2 0,5d").is_err(), "a number without a d beside one that has it is neither");
        assert_eq!(typed("red 7d 3,5d"), typed("red 7d,3.5d"));
        assert_eq!(typed("7,3.5"), typed("7d,3.5d"));
        assert_eq!(typed("-0,71,0,2"), typed("-0.71,0.2"));
        assert_eq!(typed("1,0.5"), typed("1d,0.5d"), "also where they could be metres");
        assert_eq!(typed("1,0.5 6,2 0.3,0.2"), typed("1d,0.5d 6d,2d 0.3d,0.2d"));
        assert_eq!(typed("-0.71,0.1 1,0.5 0.2,0.3").unwrap().balls[1], DVec2::new(1.0, 0.5), "unless one is negative");
    }

    #[test]
    fn lengths_count_from_the_middle() {
        let place = DVec2::new(1.0, -0.25);
        for same in ["1m,-0.25m", "1m,-25cm", "1000mm,-250mm", "1000mm -250mm", "1m,-0,25m"] {
            assert!(typed(same).unwrap().balls[2].distance(place) < 1e-12, "{same}");
        }
        assert!(typed("100 cm").unwrap_err().contains("\"cm\" is not a position"), "a unit stands at its number");
        assert!(typed("20in,-1ft").unwrap().balls[2].distance(DVec2::new(0.508, -0.3048)) < 1e-12);
        assert!(typed("2d,10cm").unwrap_err().contains("\"2d,10cm\""), "two origins");
        assert_eq!(Layout::parse("-71cm,0cm 0m,0m 30in,1ft", &Table::default()).unwrap().balls[0].x, -0.71);
    }

    #[test]
    fn invalid_positions_are_named_with_accepted_ones() {
        for (text, part) in [
            ("", "where is the ball? write one place"),
            ("red 2d,1d RED: 3d,1d", "red is put in two places"),
            ("2d,1d 3d,1d", "2 places"),
            ("blue 2d,1d", "\"blue\""),
            ("2d", "\"2d\""),
            ("2d,1", "\"2d,1\""),
            ("1,5,2", "\"1,5,2\""),
            ("red 2d", "where is red?"),
            ("red 2d,1d 3d", "some have none"),
            ("red", "where is red?"),
            ("red 2d,1d 3d,3d", "some have none"),
            ("9d,1d", "red at 9.00d,1.00d is outside the table; accepted are 0.09d to 7.91d, and 0.09d to 3.91d"),
            ("9,0.1", "red at 9.00d,0.10d is outside the table"),
            ("-9,0.1", "|x| <= 1.389"),
            ("2,2.4", "yellow and red are 0.0405 m apart; at least 0.0615 m is needed"),
            ("nan,1", "finite"),
            ("w -9,0.1", "white at (-9"),
            ("y 9m,0.1m", "yellow at (9"),
        ] {
            let error = typed(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
