//! The training screen as one sees it: keys and reports go through the real app, and its pictures are compared.

use std::{path::Path, sync::Arc, time::Duration};

use crate::training_player::{
    ASCII, NAME, NO_COLOUR, OTHER, Player, RUNS, TRUE_COLOUR, config, known, record, standing, summaries, summary,
};
use carom::{
    game::Rule,
    learning::{
        Policy,
        run::{
            follow::{Condition, Update},
            list::{Listing, Stage},
            request::Request,
            standing::Phase,
        },
    },
    table::Table,
    terminal::{App, CoachWorker, Effect, Failure, Kept, KeyContext, Launch, Report, Slot, TrainingContext},
};
use crossterm::event::{KeyCode, KeyEvent};
use proptest::prelude::*;
use ratatui::{layout::Size, style::Color};

fn check(name: &str, player: &Player) {
    for (width, height) in [(80, 24), (120, 40)] {
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), without_moments(&player.text(width, height)));
    }
}

fn failure(process: Option<u32>, sentence: &str) -> Failure {
    Failure { process, sentence: sentence.to_owned() }
}

/// The text with every moment of the form 20261120-143005 that is now replaced.
fn without_moments(text: &str) -> String {
    let mut text = text.to_owned();
    let is_moment = |part: &[u8]| {
        part.iter().enumerate().all(|(n, byte)| if n == 8 { *byte == b'-' } else { byte.is_ascii_digit() })
    };
    for start in 0..text.len().saturating_sub(15) {
        let part = &text.as_bytes()[start..start + 15];
        if is_moment(part) && !NAME.as_bytes().starts_with(part) && !OTHER.as_bytes().starts_with(part) {
            text.replace_range(start..start + 15, "yyyymmdd-hhmmss");
        }
    }
    text
}

#[test]
fn the_list_of_runs() {
    let player = Player::new().report(Report::Runs(Ok(summaries().into())));
    check("runs", &player);
    let down = player.press("Down Down Down");
    check("runs_marked", &down);
    let effects = down.press("r").effects;
    let folder = Path::new(RUNS).join("20261118-three-cushions/seed-1");
    assert!(matches!(&effects[..], [Effect::Train(launch)] if **launch == Launch::resume(&folder)), "{effects:?}");
}

#[test]
fn the_newest_run_comes_first_and_the_mark_stays_at_its_run() {
    let player = Player::new().report(Report::Runs(Ok(summaries().into()))).press("Down");
    let mut more = summaries();
    more.push(summary("20261121-000000-ddpg-match-r3-9", 0, None, Stage::Running));
    let player = player.report(Report::Runs(Ok(more.into()))).press("Enter");
    assert_eq!(player.app.wanted().followed[0].as_deref(), Some(Path::new(RUNS).join(OTHER).as_path()));
}

#[test]
fn an_empty_list_says_what_to_press() {
    check("runs_empty", &Player::new().report(Report::Runs(Ok(Listing::default()))));
    let broken = Player::new().report(Report::Runs(Err("/runs: permission denied".into())));
    broken.says("/runs: permission denied");
    Player::new().press("Enter").says("there is no run yet; n starts one");
}

#[test]
fn a_new_run_is_filled_in_and_started() {
    let player = Player::new().report(Report::Runs(Ok(summaries().into()))).press("n");
    check("form", &player);
    let player = player.press("Down Right Right Down Right Down Backspace Backspace 7 Down Right Down Right");
    check("form_filled", &player);
    let mut player = player.press("Enter");
    let Some(Effect::Train(launch)) = player.effects.pop() else { panic!("Enter starts nothing") };
    let arguments: Vec<_> = launch.arguments.iter().map(|argument| argument.to_str().unwrap()).collect();
    let folder = launch.folder.to_str().unwrap();
    let wanted = ["train", "--agent", "ddpg", "--reward", "one-cushion", "--table", "textbook", "--steps", "500007"];
    assert_eq!(arguments[..9], wanted);
    assert_eq!(arguments[9..], ["--seed", "2", "--from", &format!("{RUNS}/{NAME}"), "--run", folder]);
    assert!(folder.starts_with("/runs/20") && folder.ends_with("-ddpg-textbook-one-cushion-2"), "{folder}");
    assert_eq!(player.app.wanted().followed[0].as_deref(), Some(launch.folder.as_path()));
    let missing = Update { condition: Some(Condition::Missing), ..Update::default() };
    let failed = player
        .report(Report::Followed(Slot::Main, launch.folder.clone(), Box::new(missing)))
        .report(Report::TrainerFailed(launch.folder.clone(), failure(Some(7), "the disk is full")));
    failed.says("the disk is full");
}

#[test]
fn numbers_that_start_nothing_are_refused_with_what_is_accepted() {
    let empty = Player::new().press("n Down Down Down Backspace Backspace Backspace Backspace Backspace Backspace");
    let player = empty.press("Backspace Enter");
    assert!(player.effects.is_empty());
    player.says("\"\" is no number of shots; accepted is any number from 1 on");
}

#[test]
fn a_run_that_trains() {
    let player = Player::watching(TRUE_COLOUR);
    check("watch", &player);
    for part in
        ["1,200,000", "34", "433", "2 h 26 min", "46 min 12 s", "0.153", "60 %", "Shot 3 of 3", "point", "training"]
    {
        player.says(part);
    }
    insta::assert_snapshot!("watch_200x60", player.text(200, 60));
    check("watch_help", &player.press("?"));
    let mut scrolled = Player::watching(TRUE_COLOUR);
    scrolled.app.resize(Size::new(80, 24));
    let scrolled = scrolled.press("?");
    let keys = |key: &str, times| vec![key; times].join(" ");
    let scrolled = scrolled.press(&keys("Down", 60));
    check("watch_help_end", &scrolled);
    let end = scrolled.text(80, 24);
    let back = scrolled.press("Up");
    assert_ne!(back.text(80, 24), end, "what is beyond the end is not counted");
}

#[test]
fn every_condition_says_what_it_is_and_what_to_do() {
    let watching = || Player::watching(TRUE_COLOUR);
    check("watch_paused", &watching().condition(Condition::Is(Phase::Paused), None));
    check("watch_stalled", &watching().condition(Condition::Stalled(Duration::from_secs(40)), None));
    check("watch_died", &watching().condition(Condition::Died, None));
    let reason =
        "training stopped after 1200000 shots: the loss is not a finite number any more; try a lower learning rate";
    check("watch_failed", &watching().condition(Condition::Is(Phase::Failed), Some(reason)));
    check("watch_finished", &watching().condition(Condition::Is(Phase::Finished), None));
    watching().condition(Condition::Is(Phase::Measuring), None).says("measuring");
    watching()
        .condition(Condition::Is(Phase::Stopped), None)
        .says("carom train --resume 20261120-091500-ddpg-match-r3-1");
    watching().condition(Condition::Removed, None).says("the folder of the run has been removed");
}

#[test]
fn what_is_wrong_with_the_files_is_said() {
    let notices = Some(vec!["metrics.jsonl has been emptied".to_owned(), "3 lines are no records".to_owned()]);
    let player = Player::watching(TRUE_COLOUR);
    let player = player.update(Slot::Main, NAME, Update { notices, ..Update::default() });
    player.says("metrics.jsonl has been emptied; 3 lines are no records");
}

#[test]
fn a_run_of_which_nothing_is_known_yet() {
    let player = Player::new().report(Report::Runs(Ok(summaries().into()))).press("Enter");
    check("watch_unknown", &player);
    player.press("w").says("there is no run yet");
}

#[test]
fn charts_are_chosen_and_enlarged() {
    let player = Player::watching(TRUE_COLOUR).press("Tab Tab z l s");
    check("watch_enlarged", &player);
    let player = player.press("z 1 2 4 9");
    check("watch_two_charts", &player);
    let player = player.press("3 9");
    player.says("No chart is shown");
    player.press("z").says("no chart is shown; 1 to 9 show some");
}

#[test]
fn a_run_is_compared_with_another() {
    let player = Player::watching(TRUE_COLOUR).press("c");
    check("compare_list", &player);
    let player = player.press("Down Enter");
    assert_eq!(player.app.wanted().followed[1].as_deref(), Some(Path::new(RUNS).join(OTHER).as_path()));
    let mut other = known();
    other.records = (1..=250).map(record).collect();
    let player = player.update(Slot::Compared, OTHER, other);
    check("compare", &player);
    player.says("success 0.874 after 5,000,000 shots");
    let player = player.press("c");
    assert_eq!(player.app.wanted().followed[1], None);
    let same = Player::watching(TRUE_COLOUR).press("c Enter");
    same.says("a run cannot be compared with itself");
}

#[test]
fn a_run_is_steered_by_requests() {
    let folder = Path::new(RUNS).join(NAME);
    let player = Player::watching(TRUE_COLOUR).press("p");
    let paused = player.report(Report::Sent(Request::Pause, Ok(())));
    paused.says("the run is asked to pause");
    let paused = paused.condition(Condition::Is(Phase::Paused), None);
    paused.says("paused and saved; p lets it go on");
    let sent: Vec<_> = paused
        .press("p S n S y A y")
        .effects
        .into_iter()
        .map(|effect| match effect {
            Effect::Send(request, to) if to == folder => request,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(sent, [Request::Pause, Request::GoOn, Request::Stop, Request::Abandon]);
    let refused =
        Player::watching(TRUE_COLOUR).report(Report::Sent(Request::Stop, Err("read-only file system".into())));
    refused.says("the run cannot be asked: read-only file system");
    let died = Player::watching(TRUE_COLOUR).condition(Condition::Died, None).press("p");
    died.says("the run is not at work");
    let effects = died.press("r").effects;
    assert!(matches!(&effects[..], [Effect::Train(launch)] if **launch == Launch::resume(&folder)), "{effects:?}");
}

#[test]
fn a_question_ends_with_what_it_is_about() {
    for (keys, condition) in [("A", Condition::Is(Phase::Stopped)), ("S", Condition::Died), ("k", Condition::Removed)] {
        let player = Player::watching(TRUE_COLOUR).press(keys).condition(condition, None);
        assert_eq!(player.app.place(), KeyContext::Training(TrainingContext::Watch), "{keys}");
        let player = player.press("y Enter");
        assert!(player.effects.is_empty(), "{keys}: {:?}", player.effects);
    }
    let stopped = Player::watching(TRUE_COLOUR).press("A").condition(Condition::Is(Phase::Stopped), None);
    stopped.says("the run is not at work");
    let paused = Player::watching(TRUE_COLOUR).press("A").condition(Condition::Is(Phase::Paused), None);
    assert!(matches!(&paused.press("y").effects[..], [Effect::Send(Request::Abandon, _)]));
}

#[test]
fn a_run_is_started_once_however_long_the_key_is_held() {
    let died = || Player::watching(TRUE_COLOUR).condition(Condition::Died, None);
    let player = died().press("r r r");
    assert_eq!(player.effects.len(), 1);
    player.says("the run is being started");
    let player = player.press("Esc").report(Report::Runs(Ok(vec![summary(NAME, 9, None, Stage::Interrupted)].into())));
    assert_eq!(player.press("r r").effects.len(), 1, "nor from the list");
    let again = died().press("r").condition(Condition::Is(Phase::Training), None).condition(Condition::Died, None);
    assert_eq!(again.press("r").effects.len(), 2, "it has come and gone");
    let folder = Path::new(RUNS).join(NAME);
    let failed = died().press("r").report(Report::TrainerFailed(folder, failure(Some(7), "the disk is full")));
    failed.says("the disk is full");
    assert_eq!(failed.press("r").effects.len(), 2);
}

#[test]
fn a_second_process_that_is_refused_is_no_news_of_the_run() {
    let folder = || Path::new(RUNS).join(NAME);
    let refused = |process| Report::TrainerFailed(folder(), failure(Some(process), "another process is training"));
    let silent = |player: &Player| player.app.toasts().shown().is_empty();
    let at_work = Player::watching(TRUE_COLOUR).report(refused(7));
    assert!(silent(&at_work));
    at_work.report(refused(standing().process)).says("another process is training");
    let early = Player::watching(TRUE_COLOUR).condition(Condition::Died, None).report(refused(7));
    early.says("another process is training");
}

#[test]
fn weights_that_are_not_there_are_not_offered() {
    let finished = || Player::watching(TRUE_COLOUR).condition(Condition::Is(Phase::Finished), None);
    finished().says("w uses these weights in the coach");
    let without = finished().has_policy(false);
    without.says("finished; it has left no policy for the coach");
    let hints = without.text(120, 40).lines().nth(39).map(str::to_owned).unwrap();
    assert!(!hints.contains("w use") && !hints.contains("k keep"), "{hints}");
    for key in ["w", "k"] {
        let player = finished().has_policy(false).press(key);
        assert!(player.effects.is_empty() && player.app.place() == KeyContext::Training(TrainingContext::Watch));
        player.says("the run has no policy for the coach");
    }
}

#[test]
fn a_run_whose_configuration_cannot_be_read_is_shown_all_the_same() {
    let broken = || {
        let notices = Some(vec!["config.json cannot be read; the charts are shown without it".to_owned()]);
        let update = Update { config: None, examples: None, notices, ..known() };
        let list = Player::new().report(Report::Runs(Ok(summaries().into()))).press("Enter").has_policy(true);
        list.update(Slot::Main, NAME, update)
    };
    check("watch_no_config", &broken());
    broken().says("4 held-out reward");
    for key in ["w", "k"] {
        let player = broken().press(key);
        assert!(player.effects.is_empty());
        player.says("config.json of the run cannot be read");
    }
    assert_eq!(broken().press("c").app.place(), KeyContext::Training(TrainingContext::Compare));
}

#[test]
fn the_coach_takes_the_bundled_weights_again() {
    let folder = Path::new(RUNS).join(NAME);
    let table = Table::default();
    let policy = Policy::bundled(&table, Rule::ThreeCushion).unwrap().unwrap();
    let config = Some(Box::new(config("three-cushion")));
    let player = Player::watching(TRUE_COLOUR).update(Slot::Main, NAME, Update { config, ..Update::default() });
    let player = player.report(Report::Policy(folder, Ok(Arc::new(policy))));
    let asked = |player: &Player| (player.app.coach().query.name().to_owned(), player.app.coach().query.rule);
    assert_eq!(asked(&player), (NAME.to_owned(), Rule::ThreeCushion));
    player.says("b bundled");
    let player = player.press("b");
    assert_eq!(asked(&player), ("the bundled policy".to_owned(), Rule::default()));
    assert!(!player.text(120, 40).contains("b bundled"));
    player.press("b").says("the bundled weights are asked already");
}

#[test]
fn a_reward_that_is_no_success_is_not_called_one() {
    let config = Some(Box::new(config("r1-difficulty")));
    let player = Player::watching(TRUE_COLOUR).update(Slot::Main, NAME, Update { config, ..Update::default() });
    player.says("4 held-out reward");
    let text = player.text(120, 40);
    assert!(!text.contains("success") && !text.contains("95 %") && !text.contains("point"), "{text}");
}

#[test]
fn abandoning_asks_first_and_says_what_is_lost() {
    let player = Player::watching(TRUE_COLOUR).press("A");
    check("abandon", &player);
    assert_eq!(player.app.place(), KeyContext::Training(TrainingContext::Question));
    let player = player.press("x q");
    assert!(player.effects.is_empty(), "q is no here, and leaves nothing");
    assert_eq!(player.app.place(), KeyContext::Training(TrainingContext::Watch));
}

#[test]
fn a_policy_is_kept_under_a_name() {
    let player = Player::watching(TRUE_COLOUR).press("k");
    check("keep", &player);
    let mut player = player;
    for _ in 0..60 {
        player = player.press("Backspace");
    }
    let player = player.press("Enter");
    player.says("\"\" is no name for a policy; accepted are 1 to 100 letters");
    let player = player.press("a / q Enter");
    player.says("\"a/q\" is no name for a policy");
    let mut player = player.press("Backspace Backspace q Enter");
    let Some(Effect::Keep(keeping)) = player.effects.pop() else { panic!("nothing is kept") };
    assert_eq!((keeping.folder.as_path(), keeping.name.as_str()), (Path::new("/policies"), "aq"));
    assert_eq!(keeping.from, Path::new(RUNS).join(NAME).join("policy.safetensors"));
    let player = player.report(Report::Kept(*keeping, Ok(Kept::Taken)));
    player.says("there is a policy called aq already; replace it?");
    let mut player = player.press("y");
    let Some(Effect::Keep(keeping)) = player.effects.pop() else { panic!("nothing is kept") };
    assert!(keeping.replace);
    player.report(Report::Kept(*keeping, Ok(Kept::Done))).says("kept; use it by: carom recommend --policy aq");
}

#[test]
fn a_policy_is_used_in_the_coach_with_its_rule() {
    let folder = Path::new(RUNS).join(NAME);
    let thesis = Table::preset("thesis").unwrap();
    let mut config = config("three-cushion");
    config.table = thesis.clone();
    let update = Update { config: Some(Box::new(config)), ..Update::default() };
    let mut player = Player::watching(TRUE_COLOUR).update(Slot::Main, NAME, update).press("w");
    assert!(matches!(player.effects.pop(), Some(Effect::LoadPolicy(from)) if from == folder));
    let none = player.report(Report::Policy(folder.clone(), Err("the run has no policy".into())));
    none.says("the run has no policy");
    let policy = Policy::bundled(&thesis, Rule::ThreeCushion).unwrap().unwrap();
    let mut player = none.report(Report::Policy(folder, Ok(Arc::new(policy))));
    assert_eq!((player.app.place(), player.app.table()), (KeyContext::Coach, &thesis));
    insta::assert_snapshot!("used_in_the_coach", player.text(120, 40));
    player = player.press("Enter");
    let Some(Effect::Recommend(job)) = player.effects.pop() else { panic!("the coach is not asked") };
    assert_eq!(job.query.rule, Rule::ThreeCushion);
    CoachWorker::unhurried(20_000).answer(&job, |answer| drop(player.app.receive(answer)));
    assert!(player.app.shot().is_some_and(|shot| shot.solved), "{}", player.text(120, 40));
}

#[test]
fn escape_goes_back_page_by_page_to_the_coach_or_to_the_shell() {
    let player = Player::watching(TRUE_COLOUR).press("c Esc Esc n Esc");
    assert_eq!(player.app.place(), KeyContext::Training(TrainingContext::Runs));
    assert_eq!(player.app.wanted().followed, [None, None], "nobody watches any more");
    let player = player.press("Esc");
    assert_eq!((player.app.place(), player.app.wanted().runs), (KeyContext::Coach, None));
    let mut alone = App::watching(TRUE_COLOUR, Some(Path::new(RUNS).join(NAME)), None).unwrap();
    assert_eq!(alone.place(), KeyContext::Training(TrainingContext::Watch));
    let escape = KeyEvent::from(KeyCode::Esc);
    assert!(alone.handle(&escape).is_none());
    assert_eq!(alone.place(), KeyContext::Training(TrainingContext::Runs));
    assert!(matches!(alone.handle(&escape), Some(Effect::Quit)));
}

#[test]
fn without_colours_letters_tell_everything() {
    check("watch_ascii", &Player::watching(ASCII));
    let player = Player::watching(NO_COLOUR);
    check("watch_no_colour", &player);
    for cell in player.draw(120, 40).backend().buffer().content() {
        assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{cell:?}");
    }
    for keys in ["", "?", "Esc", "Esc n", "c"] {
        let text = Player::watching(ASCII).press(keys).text(120, 40);
        assert!(text.is_ascii(), "{keys}\n{text}");
    }
}

#[test]
fn numbers_that_change_keep_their_places() {
    let columns = |shots: u64, speed: f64| {
        let mut standing = standing();
        (standing.shots, standing.shots_per_second) = (shots, speed);
        let update = Update { standing: Some(standing), ..Update::default() };
        let player = Player::watching(TRUE_COLOUR).update(Slot::Main, NAME, update);
        let buffer = player.draw(120, 40).backend().buffer().clone();
        buffer.content().to_vec()
    };
    let (before, after) = (columns(1_200_000, 433.0), columns(1_200_433, 1298.0));
    let changes = before.iter().zip(&after).filter(|(one, other)| one != other).count();
    assert!((4..24).contains(&changes), "{changes} cells");
}

#[test]
fn every_size_can_be_drawn() {
    let player = Player::watching(TRUE_COLOUR).press("5 6 7 8 9");
    for width in (1..=240).step_by(9) {
        for height in (1..=90).step_by(7) {
            player.draw(width, height);
        }
    }
    player.says("1 mean reward");
}

/// What one may press and what may come at any time.
const KEYS: &str = "Enter Esc t n r c p S A w k y Space , . l s z + - Left Right Up Down 0 End Tab 1 \
    2 9 ? g q Backspace x 7 F2 F3 F4 F5 F6";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn no_series_of_keys_and_news_breaks_the_program(
        steps in prop::collection::vec((0..KEYS.split(' ').count(), 0_u8..12), 1..60),
        width in 20_u16..220,
        height in 5_u16..70,
    ) {
        let mut player = Player::new();
        for (key, news) in steps {
            player = player.press(KEYS.split(' ').nth(key).unwrap());
            player = match news {
                0 => player.report(Report::Runs(Ok(summaries().into()))),
                1 => player.report(Report::Runs(Ok(Listing::default()))),
                2 => player.update(Slot::Main, NAME, known()),
                3 => player.update(Slot::Compared, OTHER, known()),
                4 => player.condition(Condition::Died, None),
                5 => player.condition(Condition::Is(Phase::Finished), None),
                6 => player.report(Report::TrainerFailed(Path::new(RUNS).join(NAME), failure(None, "it failed"))),
                7 => player.has_policy(true),
                _ => player,
            };
            player.app.tick(0.7);
            if news > 9 {
                player.draw(width, height);
            }
        }
        player.draw(width, height);
    }
}
