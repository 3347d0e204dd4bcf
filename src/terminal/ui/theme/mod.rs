//! Colours of everything on the screen, reduced to what the terminal supports.

mod themes;

use ratatui::style::{Color, Modifier, Style};

use crate::{table::CueBall, terminal::Depth};

pub use themes::{ThemeName, UnknownTheme};

/// The 16 colours of every terminal, in the order of their codes.
pub const ANSI: [Color; 16] = [
    Color::Black,
    Color::Red,
    Color::Green,
    Color::Yellow,
    Color::Blue,
    Color::Magenta,
    Color::Cyan,
    Color::Gray,
    Color::DarkGray,
    Color::LightRed,
    Color::LightGreen,
    Color::LightYellow,
    Color::LightBlue,
    Color::LightMagenta,
    Color::LightCyan,
    Color::White,
];

/// Colours by purpose. In monochrome all of them are [`Color::Reset`]: under `NO_COLOR`, crossterm turns bold and reverse video off with
/// every colour command, so only letters and modifiers may distinguish things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// Colour depth that the colours are made for.
    pub depth: Depth,
    /// Behind the panels.
    pub background: Color,
    /// Ordinary text.
    pub text: Color,
    /// Labels and units.
    pub faint: Color,
    /// Rules and axes.
    pub rule: Color,
    /// Keys, the selected ball, the present event.
    pub accent: Color,
    /// Pointers on the rails to the selected ball.
    pub mark: Color,
    /// A point.
    pub good: Color,
    /// Something refused, or a shot that misses.
    pub warning: Color,
    /// The cloth.
    pub cloth: Color,
    /// The cushions' rubber, under the same cloth in shadow.
    pub cushion: Color,
    /// The rails.
    pub wood: Color,
    /// The sights in the rails.
    pub sight: Color,
    /// The cue before the stroke.
    pub cue: Color,
    /// Which ball the player plays with.
    pub cue_ball: CueBall,
    /// The cue ball, the opponent's and the red ball.
    pub balls: [Color; 3],
    /// Colours of their signs in text, visible on the background.
    pub signs: [Color; 3],
    /// Colour of the sign for the cue ball's path, in text.
    pub next_path_sign: Color,
    /// The dots of the balls' paths.
    pub paths: [Color; 3],
    /// The dots of the cue ball's path in the next shot.
    pub next_path: Color,
    /// The cue ball's face, except the tip contact.
    pub face: Color,
    /// The part of the face where the tip would slip off.
    pub miscue: Color,
    /// The tip contact.
    pub tip: Color,
    /// The curves of a run and of the run compared with it.
    pub curves: [Color; 2],
    /// The raw values of both runs, behind their smoothed curves.
    pub bands: [Color; 2],
    /// Outcomes of a stroke: no result, no ball hit, one ball hit, both hit with too few cushions, a point.
    pub outcomes: [Color; 5],
    /// The outline of the player's errors, drawn over the outcomes.
    pub outline: Color,
    /// The grid lines behind the curves.
    pub grid: Color,
    /// Modifier for emphasized words, in addition to their colour.
    pub strong: Modifier,
}

impl Theme {
    /// Creates the dark theme for `depth`.
    pub fn new(depth: Depth) -> Self {
        let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
        let balls = [
            ink(0x00f7_f3e8, 255, Color::White),
            ink(0x00f6_c324, 220, Color::LightYellow),
            ink(0x00d9_3636, 160, Color::Red),
        ];
        Self {
            depth,
            background: ink(0x0010_1418, 233, Color::Black),
            text: ink(0x00d6_dbe0, 253, Color::White),
            faint: ink(0x0084_909b, 246, Color::Gray),
            rule: ink(0x004e_5a65, 240, Color::DarkGray),
            accent: ink(0x00ff_c66d, 221, Color::LightYellow),
            mark: ink(0x00ff_c66d, 221, Color::LightYellow),
            good: ink(0x0079_d28b, 114, Color::LightGreen),
            warning: ink(0x00ff_8a70, 209, Color::LightRed),
            cloth: ink(0x001b_6d83, 24, Color::Blue),
            cushion: ink(0x0011_4a5c, 23, Color::Cyan),
            wood: ink(0x006b_4128, 94, Color::DarkGray),
            sight: ink(0x00f3_e3bf, 223, Color::White),
            cue: ink(0x00e2_bb82, 180, Color::Gray),
            cue_ball: CueBall::White,
            balls,
            signs: balls,
            next_path_sign: ink(0x007e_e787, 114, Color::LightGreen),
            paths: [
                ink(0x00b9_d3d8, 152, Color::Gray),
                ink(0x00d8_c05a, 179, Color::Yellow),
                ink(0x00ee_8f83, 210, Color::LightRed),
            ],
            next_path: ink(0x007e_e787, 114, Color::LightGreen),
            face: ink(0x00f7_f3e8, 255, Color::White),
            miscue: ink(0x00c3_c4be, 251, Color::DarkGray),
            tip: ink(0x001f_63c8, 26, Color::Blue),
            curves: [ink(0x0062_c8e8, 80, Color::LightCyan), ink(0x00d8_9a5a, 173, Color::Yellow)],
            bands: [ink(0x0027_5b6e, 24, Color::Blue), ink(0x0059_4530, 58, Color::DarkGray)],
            outcomes: [
                ink(0x0026_2f36, 236, Color::Black),
                ink(0x004c_5861, 240, Color::DarkGray),
                ink(0x0098_5a3c, 131, Color::Red),
                ink(0x00d9_b04c, 178, Color::Yellow),
                ink(0x005c_bd72, 71, Color::Green),
            ],
            outline: ink(0x00f7_f3e8, 255, Color::White),
            grid: ink(0x0036_3f48, 237, Color::DarkGray),
            strong: Modifier::BOLD,
        }
    }

    /// Adapts the theme to the player's cue ball: the balls keep their colours, but their order changes.
    #[must_use]
    pub fn with_cue_ball(&self, cue_ball: CueBall) -> Self {
        if cue_ball == self.cue_ball {
            return *self;
        }
        // Applying it twice gives the original order.
        let [balls, signs, paths] =
            [self.balls, self.signs, self.paths].map(|colours| CueBall::Yellow.to_ball_order(colours));
        Self { cue_ball, balls, signs, paths, face: balls[0], ..*self }
    }

    /// Names of the balls.
    pub const fn names(&self) -> [&'static str; 3] {
        self.cue_ball.names()
    }

    /// Letters of the balls.
    pub fn letters(&self) -> [char; 3] {
        self.cue_ball.to_ball_order(['W', 'Y', 'R'])
    }

    /// Whether only letters and modifiers distinguish things.
    pub fn is_mono(&self) -> bool {
        self.depth == Depth::Mono
    }

    /// Style of ordinary text.
    pub fn text(&self) -> Style {
        Style::new().fg(self.text).bg(self.background)
    }

    /// Style of labels and units.
    pub fn faint(&self) -> Style {
        self.text().fg(self.faint)
    }

    /// Style of rules and axes.
    pub fn rule(&self) -> Style {
        self.text().fg(self.rule)
    }

    /// Style of keys and of the selection.
    pub fn accent(&self) -> Style {
        self.text().fg(self.accent).add_modifier(self.strong)
    }

    /// Style of success messages.
    pub fn good(&self) -> Style {
        self.text().fg(self.good).add_modifier(self.strong)
    }

    /// Style of refusals.
    pub fn warning(&self) -> Style {
        self.text().fg(self.warning).add_modifier(self.strong)
    }

    /// Style of the letter of `ball` on the table: dark on the ball's colour. A letter in the ball's colour would be hard to see on the
    /// cloth.
    pub fn ball_letter(&self, ball: usize) -> Style {
        let ink = resolve(self.depth, 0x0010_1418, 16, Color::Black);
        if self.is_mono() { Style::new() } else { Style::new().fg(ink).bg(self.balls[ball]) }
    }

    /// Colour of a path that the ball has already run: midway between the path's colour and the cloth's.
    pub fn past_path(&self, ball: usize) -> Color {
        match (self.paths[ball], self.cloth) {
            (Color::Rgb(r, g, b), Color::Rgb(cloth_r, cloth_g, cloth_b)) => {
                Color::Rgb(r.midpoint(cloth_r), g.midpoint(cloth_g), b.midpoint(cloth_b))
            }
            (Color::Indexed(_), _) => Color::Indexed(self.cue_ball.to_ball_order([73, 107, 131])[ball]),
            (Color::Reset, _) => Color::Reset,
            _ => Color::Cyan,
        }
    }

    /// Colour of the shadow of a ball in the air: half the brightness of the cloth.
    pub const fn shadow(&self) -> Color {
        match self.cloth {
            Color::Rgb(r, g, b) => Color::Rgb(r / 2, g / 2, b / 2),
            Color::Indexed(_) => Color::Indexed(16),
            Color::Reset => Color::Reset,
            _ => Color::Black,
        }
    }

    /// Style of the sign of `ball` in text.
    pub fn ball(&self, ball: usize) -> Style {
        self.text().fg(self.signs[ball])
    }

    /// The sign of a ball in text. For the white ball it is an outline if its sign has another colour than the ball, as on a light
    /// background.
    pub fn ball_sign(&self, ball: usize) -> char {
        let is_white = self.letters()[ball] == 'W';
        if is_white && self.signs[ball] != self.balls[ball] { '○' } else { '●' }
    }
}

/// One colour of the theme at `depth`: 24 bits, xterm's number, or one of the 16. The second and third are chosen by eye, because the
/// numerically nearest ones turn wood grey and yellow orange.
fn resolve(depth: Depth, rgb: u32, index: u8, ansi: Color) -> Color {
    let [_, r, g, b] = rgb.to_be_bytes();
    match depth {
        Depth::True => Color::Rgb(r, g, b),
        Depth::Indexed => Color::Indexed(index),
        Depth::Ansi => ansi,
        Depth::Mono => Color::Reset,
    }
}

#[cfg(test)]
mod tests;
