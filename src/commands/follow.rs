//! `carom follow`: look on while another player plays.

use std::sync::atomic::Ordering;

use super::{
    Failure, failure,
    output::{json_line, line, tell},
};
use crate::{
    platform::stop_when_told,
    printing,
    storage::{Places, Player},
    terminal::{self, Seat, Settings, ShownTable, Sight, all_shown, follow_in_lines},
};

/// Follow the table of another player of this account, live.
///
/// They have to allow it (F on their screen). On a terminal it is the same picture as theirs; elsewhere a line is printed for
/// whatever is new.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The player. Left out: who shows their table now.
    #[arg(value_name = "PLAYER")]
    followed: Option<Player>,
    /// Plain lines, on a terminal too.
    #[arg(long)]
    plain: bool,
    /// Every change as JSON on standard output.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args, seat: Seat) -> Result<(), Failure> {
    let Some(player) = &args.followed else { return list(args.json) };
    // Nobody is told who has a folder here and who has not.
    let hidden = || Failure::failed(format_args!("{player} shows no table now; carom follow lists who does"));
    let folder = Places::of_player(player).map_err(Failure::failed)?.shown;
    if matches!(ShownTable::look(&folder), Sight::Nothing) {
        return Err(hidden());
    }
    seat.take(Some(&folder)).map_err(Failure::failed)?;
    let (settings, _) = Settings::load(&seat.places.settings);
    let settings = seat.allowed(settings);
    if !args.plain && !args.json && terminal::is_there() {
        return terminal::follow(player.name(), &folder, &settings, seat).map_err(failure);
    }
    let stop = stop_when_told(None).map_err(Failure::failed)?;
    follow_in_lines(
        player.name(),
        &folder,
        settings.units,
        args.json,
        &stop,
        &mut printing::stdout().exact(args.json),
    )?;
    if !stop.load(Ordering::Relaxed) {
        tell(format_args!("{player} shows the table no more"));
    }
    Ok(())
}

/// Who shows their table now.
fn list(json: bool) -> Result<(), Failure> {
    let shown = all_shown();
    for player in &shown {
        if json {
            json_line(&serde_json::json!({ "player": player.name() }))?;
        } else {
            line(player)?;
        }
    }
    if shown.is_empty() {
        tell("nobody shows their table now: a player does by F on the coach's screen");
    }
    Ok(())
}
