//! `carom follow`: shows the table of another player.

use std::sync::atomic::Ordering;

use super::{
    Failure, failure,
    output::{json_line, print_line, print_note},
};
use crate::{
    platform::stop_on_signal,
    printing,
    storage::{DataPaths, Player},
    terminal::{self, Seat, Settings, SharedTable, SharedTableState, follow_in_lines, sharing_players},
};

/// Follow the table of another player of this account, live.
///
/// The other player must allow it (F on their screen). On a terminal you see the same picture as they do; elsewhere, each change is printed
/// as a line.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The player. Without a name, the players who show their table now are listed.
    #[arg(value_name = "PLAYER")]
    followed: Option<Player>,
    /// Print plain lines, even on a terminal.
    #[arg(long)]
    plain: bool,
    /// Print every change as JSON to standard output.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args, seat: Seat) -> Result<(), Failure> {
    let Some(player) = &args.followed else { return list(args.json) };
    // The message is the same for players with and without a folder, so that it does not reveal who has one.
    let hidden = || Failure::failed(format_args!("{player} shows no table now; carom follow lists the players who do"));
    let folder = DataPaths::of_player(player).map_err(Failure::failed)?.spectator_folder;
    if matches!(SharedTable::read(&folder), SharedTableState::Nothing) {
        return Err(hidden());
    }
    seat.confine_process(Some(&folder)).map_err(Failure::failed)?;
    let (settings, _) = Settings::load(&seat.paths.settings);
    let settings = seat.restrict_settings(settings);
    if !args.plain && !args.json && terminal::is_there() {
        return terminal::follow(player.name(), &folder, &settings, seat).map_err(failure);
    }
    let stop = stop_on_signal(None).map_err(Failure::failed)?;
    follow_in_lines(
        player.name(),
        &folder,
        settings.units,
        args.json,
        &stop,
        &mut printing::stdout().exact(args.json),
    )?;
    if !stop.load(Ordering::Relaxed) {
        print_note(format_args!("{player} no longer shows the table"));
    }
    Ok(())
}

/// Lists the players who show their table now.
fn list(json: bool) -> Result<(), Failure> {
    let shown = sharing_players();
    for player in &shown {
        if json {
            json_line(&serde_json::json!({ "player": player.name() }))?;
        } else {
            print_line(player)?;
        }
    }
    if shown.is_empty() {
        print_note(
            "nobody shows their table now; a player who has started carom --player NAME can do so with the key F on the coach's screen",
        );
    }
    Ok(())
}
