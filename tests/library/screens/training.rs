//! The training screen: keys and reports go through the real app, and its pictures are compared.

use std::{path::Path, sync::Arc, time::Duration};

use super::{
    keys::key,
    player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check, check_at},
    runs::{OTHER_RUN, RUN, RUNS, config, examples, full_update, listing, record, status, summary, trainer_failed},
};
use carom::{
    game::Rule,
    learning::{
        Policy,
        run::{
            follow::{Condition, Update},
            list::Listing,
            request::Request,
            status::Phase,
        },
    },
    table::Table,
    terminal::{
        App, CoachWorker, Effect, FollowSlot, KeyContext, Launch, TrainerFailure, TrainingContext, TrainingReport,
    },
};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use proptest::prelude::*;
use ratatui::layout::Size;

#[test]
fn the_list_of_runs() {
    let player = Player::listing(TRUE_COLOUR);
    check("runs", &player);
    let down = player.press("Down Down Down");
    down.shows(&[
        "▸ 20261118-three-cushions/seed-1",
        "40k    0      -      -  stopped",
        "Run 3 of 3",
        "seed 1: 40,000 of 5,000,000 shots",
        "r go on with it",
        "1 run is training",
    ]);
    let mut more = listing();
    more.runs.push(summary("20261121-000000-ddpg-match-r3-9", 0, None, Condition::InPhase(Phase::Paused)));
    Player::listing(TRUE_COLOUR).report(TrainingReport::Runs(Ok(more))).shows(&["1 run is training; 1 is paused"]);
    let effects = down.press("r").effects;
    let folder = Path::new(RUNS).join("20261118-three-cushions/seed-1");
    assert!(matches!(&effects[..], [Effect::Train(launch)] if **launch == Launch::resume(&folder)), "{effects:?}");
}

#[test]
fn the_newest_run_is_first_and_the_selection_stays() {
    let player = Player::listing(TRUE_COLOUR).press("Down");
    let mut more = listing();
    more.runs.push(summary("20261121-000000-ddpg-match-r3-9", 0, None, Condition::InPhase(Phase::Training)));
    let player = player.report(TrainingReport::Runs(Ok(more))).press("Enter");
    assert_eq!(player.followed_run(0).as_deref(), Some(Path::new(RUNS).join(OTHER_RUN).as_path()));
}

#[test]
fn an_empty_list_says_what_to_press() {
    let empty = Player::at_runs(TRUE_COLOUR).report(TrainingReport::Runs(Ok(Listing::default())));
    empty.shows(&["No agent has been trained here yet.", "Press n to start a run", "n new run"]);
    let broken = Player::at_runs(TRUE_COLOUR).report(TrainingReport::Runs(Err("/runs: permission denied".into())));
    broken.says("/runs: permission denied");
    Player::at_runs(TRUE_COLOUR).press("Enter").says("there is no run yet; n starts one");
}

#[test]
fn a_new_run_is_configured_and_started() {
    let player = Player::listing(TRUE_COLOUR).press("n");
    check("form", &player);
    let player = player.press("Down Right Right Down Right Down Backspace Backspace 7 Down Right Down Right");
    player.shows(&["one-cushion", "textbook", "500,007", "measured every 10,000 shots", RUN]);
    let mut player = player.press("Enter");
    let Some(Effect::Train(launch)) = player.effects.pop() else { panic!("Enter starts nothing") };
    let arguments: Vec<_> = launch.arguments.iter().map(|argument| argument.to_str().unwrap()).collect();
    let folder = launch.folder.to_str().unwrap();
    let wanted = ["train", "--agent", "ddpg", "--reward", "one-cushion", "--table", "textbook", "--steps", "500007"];
    assert_eq!(arguments[..9], wanted);
    assert_eq!(arguments[9..], ["--seed", "2", "--from", &format!("{RUNS}/{RUN}"), "--run", folder]);
    assert!(folder.starts_with("/runs/20") && folder.ends_with("-ddpg-textbook-one-cushion-2"), "{folder}");
    assert_eq!(player.followed_run(0).as_deref(), Some(launch.folder.as_path()));
    let failure = TrainerFailure { process: Some(7), sentence: "the disk is full".to_owned() };
    let missing = Update { condition: Some(Condition::Missing), ..Update::default() };
    let failed = player
        .report(TrainingReport::Followed(FollowSlot::Main, launch.folder.clone(), Box::new(missing)))
        .report(TrainingReport::TrainerFailed(launch.folder.clone(), failure));
    failed.says("the disk is full");
}

#[test]
fn an_empty_number_of_shots_is_refused() {
    let player = Player::at_runs(TRUE_COLOUR).press("n Down Down Down").press(&"Backspace ".repeat(7)).press("Enter");
    assert!(player.effects.is_empty());
    player.says("\"\" is not a number of shots; use 1 or more");
}

#[test]
fn the_view_of_a_training_run() {
    let player = Player::watching(TRUE_COLOUR);
    check("watch", &player);
    let figures = ["1,200,000", "34", "433", "2 h 26 min", "46 min 12 s", "0.153", "60 %", "Shot 3 of 3"];
    player.shows_at((120, 40), &figures).says("point").says("training");
    player.shows_at(
        (200, 60),
        &["F4 Training", "ddpg for r3 on \"match\"", "mean reward", "held-out success", "Shot 3 of 3", "1,200,000"],
    );
    player.press("?").shows(&["enlarge", "more lines below"]);
    let mut scrolled = Player::watching(TRUE_COLOUR);
    scrolled.app.resize(Size::new(80, 24));
    let scrolled = scrolled.press("?");
    let scrolled = scrolled.press(&"Down ".repeat(60));
    scrolled.shows(&["q Ctrl-c              quit", "Ctrl-z                back to the shell; fg continues"]);
    let end = scrolled.text(80, 24);
    let back = scrolled.press("Up");
    assert_ne!(back.text(80, 24), end, "scrolling stops at the end");
}

#[test]
fn every_condition_of_a_run_is_explained() {
    let watching = || Player::watching(TRUE_COLOUR);
    for (condition, parts) in [
        (Condition::InPhase(Phase::Paused), ["paused ", "paused and saved; p lets it go on", "p go on"]),
        (
            Condition::Stalled(Duration::from_secs(40)),
            ["stalled for 40 s", "the process is still there and may be suspended", "p pause"],
        ),
        (Condition::Died, ["died ", "r go on", "w use"]),
        (
            Condition::InPhase(Phase::Finished),
            ["finished ", "w uses these networks in the coach", "k keeps them under a name"],
        ),
    ] {
        watching().condition(condition, None).shows(&parts);
    }
    let reason =
        "training stopped after 1200000 shots: the loss is not a finite number any more; try a lower learning rate";
    check("watch_failed", &watching().condition(Condition::InPhase(Phase::Failed), Some(reason)));
    watching().condition(Condition::InPhase(Phase::Measuring), None).says("measuring");
    watching()
        .condition(Condition::InPhase(Phase::Stopped), None)
        .says("carom train --resume 20261120-091500-ddpg-match-r3-1");
    watching().condition(Condition::Removed, None).says("the folder of the run has been removed");
}

#[test]
fn problems_with_run_files_are_shown() {
    let notices = Some(vec!["metrics.jsonl has been emptied".to_owned(), "3 lines are no records".to_owned()]);
    let player = Player::watching(TRUE_COLOUR);
    let player = player.update(FollowSlot::Main, RUN, Update { notices, ..Update::default() });
    player.says("metrics.jsonl has been emptied; 3 lines are no records");
}

#[test]
fn a_run_without_data_yet() {
    let player = Player::listing(TRUE_COLOUR).press("Enter");
    player.shows(&["looking ", "no data yet", "4 held-out reward", "looking for the run"]);
    player.press("w").says("there is no run yet");
}

#[test]
fn charts_are_selected_and_enlarged() {
    let player = Player::watching(TRUE_COLOUR).press("Tab Tab z l s");
    check("watch_enlarged", &player);
    let player = player.press("z 1 2 4 9");
    player.shows(&["3 critic loss · log", "9 exploration"]).does_not_show("1 mean reward");
    let player = player.press("3 9");
    player.says("No chart is shown");
    player.press("z").says("no chart is shown; 1 to 9 show some");
    // Esc leaves the chart, not the run. A key that arrives together with it is a separate key, not one with Alt.
    let player = Player::watching(TRUE_COLOUR).press("z");
    player.does_not_show("3 critic loss");
    player.press("Esc").shows(&["1 mean reward", "3 critic loss"]);
    let mut player = Player::watching(TRUE_COLOUR).press("z");
    player.event(&KeyEvent::new(KeyCode::Char('c'), KeyModifiers::ALT));
    player.shows(&["compare with"]);
}

#[test]
fn a_run_is_compared_with_another() {
    let player = Player::watching(TRUE_COLOUR).press("c");
    // The nearest other run is selected.
    player.shows(&["compare with", RUN, OTHER_RUN, "Run 2 of 3", "Enter compare"]);
    let player = player.press("Enter");
    assert_eq!(player.followed_run(1).as_deref(), Some(Path::new(RUNS).join(OTHER_RUN).as_path()));
    let mut other = full_update();
    other.records = (1..=250).map(record).collect();
    let player = player.update(FollowSlot::Compared, OTHER_RUN, other);
    check("compare", &player);
    player.says("success 0.874 after 5,000,000 shots");
    let player = player.press("c");
    assert_eq!(player.app.subscriptions().followed[1], None);
    let same = Player::watching(TRUE_COLOUR).press("c Up Enter");
    same.says("a run cannot be compared with itself");
    same.shows(&["compare with"]);
}

#[test]
fn a_run_is_controlled_by_requests() {
    let folder = Path::new(RUNS).join(RUN);
    let player = Player::watching(TRUE_COLOUR).press("p");
    let paused = player.report(TrainingReport::Sent(Request::Pause, Ok(())));
    paused.says("the run is asked to pause");
    let paused = paused.condition(Condition::InPhase(Phase::Paused), None);
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
    assert_eq!(sent, [Request::Pause, Request::Resume, Request::Stop, Request::Abandon]);
    let refused =
        Player::watching(TRUE_COLOUR).report(TrainingReport::Sent(Request::Stop, Err("read-only file system".into())));
    refused.says("the run cannot be asked: read-only file system");
    let died = Player::watching(TRUE_COLOUR).condition(Condition::Died, None).press("p");
    died.says("the run is not training");
    let effects = died.press("r").effects;
    assert!(matches!(&effects[..], [Effect::Train(launch)] if **launch == Launch::resume(&folder)), "{effects:?}");
}

#[test]
fn a_question_closes_when_it_no_longer_applies() {
    for (keys, condition) in
        [("A", Condition::InPhase(Phase::Stopped)), ("S", Condition::Died), ("k", Condition::Removed)]
    {
        let player = Player::watching(TRUE_COLOUR).press(keys).condition(condition, None);
        assert_eq!(player.app.key_context(), KeyContext::Training(TrainingContext::Watch), "{keys}");
        let player = player.press("y Enter");
        assert!(player.effects.is_empty(), "{keys}: {:?}", player.effects);
    }
    let stopped = Player::watching(TRUE_COLOUR).press("A").condition(Condition::InPhase(Phase::Stopped), None);
    stopped.says("the run is not training");
    let paused = Player::watching(TRUE_COLOUR).press("A").condition(Condition::InPhase(Phase::Paused), None);
    assert!(matches!(&paused.press("y").effects[..], [Effect::Send(Request::Abandon, _)]));
}

#[test]
fn a_held_key_starts_a_run_only_once() {
    let died = || Player::watching(TRUE_COLOUR).condition(Condition::Died, None);
    let player = died().press("r r r");
    assert_eq!(player.effects.len(), 1);
    player.says("the run is being started");
    let listed =
        Listing { runs: vec![summary(RUN, 9, None, Condition::InPhase(Phase::Stopped))], ..Listing::default() };
    let player = player.press("Esc").report(TrainingReport::Runs(Ok(listed)));
    assert_eq!(player.press("r r").effects.len(), 1, "also from the list, only once");
    let again = died().press("r").condition(Condition::InPhase(Phase::Training), None).condition(Condition::Died, None);
    assert_eq!(again.press("r").effects.len(), 2, "the run has trained and died again");
    let failed = died().press("r").report(trainer_failed(Some(7), "the disk is full"));
    failed.says("the disk is full");
    assert_eq!(failed.press("r").effects.len(), 2);
}

#[test]
fn a_refused_second_trainer_is_not_reported() {
    let refused = |process| trainer_failed(Some(process), "another process is training");
    let silent = |player: &Player| player.app.toasts.shown.is_empty();
    let at_work = Player::watching(TRUE_COLOUR).report(refused(7));
    assert!(silent(&at_work));
    at_work.report(refused(status().process)).says("another process is training");
    let early = Player::watching(TRUE_COLOUR).condition(Condition::Died, None).report(refused(7));
    early.says("another process is training");
}

#[test]
fn missing_weights_are_not_offered() {
    let finished = || Player::watching(TRUE_COLOUR).condition(Condition::InPhase(Phase::Finished), None);
    finished().says("w uses these networks in the coach");
    let without = finished().has_policy(false);
    without.says("finished; it has left no networks for the coach");
    let hints = without.text(120, 40).lines().nth(39).map(str::to_owned).unwrap();
    assert!(!hints.contains("w use") && !hints.contains("k keeps them under a name"), "{hints}");
    for key in ["w", "k"] {
        let player = finished().has_policy(false).press(key);
        assert!(player.effects.is_empty() && player.app.key_context() == KeyContext::Training(TrainingContext::Watch));
        player.says("the run has no networks for the coach");
    }
}

#[test]
fn seen_example_shots_do_not_play_again() {
    // A follower reads the whole run again; a stopped run has measured itself after its last line.
    for after in [1_200_000, 1_210_000] {
        let news = || Update { replaces_records: true, examples: Some(examples(after)), ..full_update() };
        let seen = Player::watching(TRUE_COLOUR).update(FollowSlot::Main, RUN, news()).finish_replay().press("F2 F4");
        let again = seen.update(FollowSlot::Main, RUN, news());
        assert_eq!(again.app.frame_interval(), None, "{after}");
        // A run that was resumed from an earlier checkpoint reaches the same number with other shots.
        let mut other = examples(1_100_000);
        other.shots.pop();
        let fresh = Update { replaces_records: true, examples: Some(other), ..full_update() };
        assert!(again.update(FollowSlot::Main, RUN, fresh).app.frame_interval().is_some(), "{after}");
    }
}

#[test]
fn a_run_with_unreadable_configuration_is_shown() {
    let broken = || {
        let notices = Some(vec!["config.json cannot be read; the charts are shown without it".to_owned()]);
        let update = Update { config: None, examples: None, notices, ..full_update() };
        let list = Player::listing(TRUE_COLOUR).press("Enter").has_policy(true);
        list.update(FollowSlot::Main, RUN, update)
    };
    broken().shows(&["training ", "1 mean reward", "3 critic loss"]);
    broken().says("4 held-out reward");
    for key in ["w", "k"] {
        let player = broken().press(key);
        assert!(player.effects.is_empty());
        player.says("config.json of the run cannot be read");
    }
    assert_eq!(broken().press("c").app.key_context(), KeyContext::Training(TrainingContext::Compare));
}

#[test]
fn only_success_rewards_are_called_success() {
    let config = Some(Box::new(config("r1-difficulty")));
    let player = Player::watching(TRUE_COLOUR).update(FollowSlot::Main, RUN, Update { config, ..Update::default() });
    player.says("4 held-out reward");
    let text = player.text(120, 40);
    assert!(!text.contains("success") && !text.contains("95 %") && !text.contains("point"), "{text}");
}

#[test]
fn abandoning_needs_confirmation_and_states_the_loss() {
    let player = Player::watching(TRUE_COLOUR).press("A");
    player.shows(&["delete its folder?", "1,200,000 shots are lost", "held-out reward of 0.874", "y yes   n no"]);
    assert_eq!(player.app.key_context(), KeyContext::Question { is_typed: false });
    let player = player.press("x q");
    assert!(player.effects.is_empty(), "q answers no and does not leave the page");
    assert_eq!(player.app.key_context(), KeyContext::Training(TrainingContext::Watch));
}

#[test]
fn a_policy_is_saved_under_a_name() {
    let player = Player::watching(TRUE_COLOUR).press("k");
    player.shows(&["keep the networks under the name: 20261120-091500-ddpg-match-r3-1", "Enter take it"]);
    let player = player.press(&"Backspace ".repeat(60)).press("Enter");
    player.says("\"\" is no name for a policy; accepted are 1 to 100 letters");
    let player = player.press("a / q Enter");
    player.says("\"a/q\" is no name for a policy");
    let mut player = player.press("Backspace Backspace q Enter");
    let Some(Effect::SavePolicy(task)) = player.effects.pop() else { panic!("nothing is kept") };
    assert_eq!((task.folder.as_path(), task.name.as_str()), (Path::new("/policies"), "aq"));
    assert_eq!(task.from, Path::new(RUNS).join(RUN).join("policy.safetensors"));
    let player = player.report(TrainingReport::PolicySaved(*task, Ok(false)));
    player.says("there are networks called aq already; replace them?");
    let mut player = player.press("y");
    let Some(Effect::SavePolicy(task)) = player.effects.pop() else { panic!("nothing is kept") };
    assert!(task.replace);
    let player = player.report(TrainingReport::PolicySaved(*task, Ok(true)));
    player.says("kept; use them with: carom recommend --policy aq");
}

#[test]
fn a_taken_name_is_reported_over_another_question() {
    let mut player = Player::watching(TRUE_COLOUR).press("k Enter S");
    let Some(Effect::SavePolicy(task)) = player.effects.pop() else { panic!("nothing is kept") };
    let player = player.report(TrainingReport::PolicySaved(*task, Ok(false)));
    player.warns("is not saved: there is another of this name");
    player.says("measure it, save it and end it?");
}

#[test]
fn a_policy_is_used_in_the_coach_with_its_rule() {
    let folder = Path::new(RUNS).join(RUN);
    let thesis = Table::preset("thesis").unwrap();
    let mut config = config("three-cushion");
    config.table = thesis.clone();
    let update = Update { config: Some(Box::new(config)), ..Update::default() };
    let mut player = Player::watching(TRUE_COLOUR).update(FollowSlot::Main, RUN, update).press("w");
    assert!(matches!(player.effects.pop(), Some(Effect::LoadPolicy(from)) if from == folder));
    let none = player.report(TrainingReport::Policy(folder.clone(), Err("the run has no policy".into())));
    none.says("the run has no policy");
    let policy = Policy::bundled(&thesis, Rule::ThreeCushion).unwrap().unwrap();
    let mut player = none.report(TrainingReport::Policy(folder, Ok(Arc::new(policy))));
    assert_eq!((player.app.key_context(), player.app.coach.table()), (KeyContext::Coach, &thesis));
    player.shows(&["no shot yet", "Enter ask", "b bundled", RUN]);
    player = player.press("Enter");
    let job = player.advice_job.take().expect("the coach is asked");
    assert_eq!(job.query.rule, Rule::ThreeCushion);
    CoachWorker::with_simulation_limit(20_000).answer(&job, |answer| drop(player.app.receive(answer)));
    assert!(player.app.coach.shot().is_some_and(|shot| shot.solved), "{}", player.text(120, 40));
}

#[test]
fn escape_goes_back_page_by_page() {
    let player = Player::watching(TRUE_COLOUR).press("c Esc Esc n Esc");
    assert_eq!(player.app.key_context(), KeyContext::Training(TrainingContext::Runs));
    assert_eq!(player.app.subscriptions().followed, [None, None], "nobody watches any more");
    let player = player.press("Esc");
    assert_eq!((player.app.key_context(), player.app.subscriptions().runs), (KeyContext::Coach, None));
    let mut alone = App::watching(TRUE_COLOUR, Some(Path::new(RUNS).join(RUN)), None).unwrap();
    assert_eq!(alone.key_context(), KeyContext::Training(TrainingContext::Watch));
    let escape = KeyEvent::from(KeyCode::Esc);
    assert!(alone.handle(&escape).is_none());
    assert_eq!(alone.key_context(), KeyContext::Training(TrainingContext::Runs));
    assert!(matches!(alone.handle(&escape), Some(Effect::Quit)));
}

#[test]
fn the_training_screens_are_complete_without_colours() {
    let plain = Player::watching(ASCII);
    check_at(&[(120, 40)], "watch_ascii", &plain);
    plain.is_plain();
    let player = Player::watching(NO_COLOUR);
    player.is_plain().shows(&["4 held-out success", "Shot 3 of 3"]);
    for keys in ["", "?", "Esc", "Esc n", "c"] {
        Player::watching(ASCII).press(keys).is_plain();
    }
}

#[test]
fn changing_numbers_keep_their_columns() {
    let columns = |shots: u64, speed: f64| {
        let mut status = status();
        (status.shots, status.shots_per_second) = (shots, speed);
        let update = Update { status: Some(status), ..Update::default() };
        let player = Player::watching(TRUE_COLOUR).update(FollowSlot::Main, RUN, update);
        player.picture(120, 40).content().to_vec()
    };
    let (before, after) = (columns(1_200_000, 433.0), columns(1_200_433, 1298.0));
    let changes = before.iter().zip(&after).filter(|(one, other)| one != other).count();
    assert!((4..24).contains(&changes), "{changes} cells");
}

/// Keys and reports that can come at any time.
const KEYS: &str = "Enter Esc t n r c p S A w k y Space , . l s z + - Left Right Up Down 0 End Tab 1 \
    2 9 ? g q Backspace x 7 F2 F3 F4 F5 F6";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn random_keys_and_reports_do_not_panic(
        steps in prop::collection::vec((0..KEYS.split(' ').count(), 0_u8..12), 1..60),
        width in 20_u16..220,
        height in 5_u16..70,
    ) {
        let mut player = Player::at_runs(TRUE_COLOUR);
        for (index, news) in steps {
            player.event(&key(KEYS.split(' ').nth(index).unwrap()));
            player = match news {
                0 => player.report(TrainingReport::Runs(Ok(listing()))),
                1 => player.report(TrainingReport::Runs(Ok(Listing::default()))),
                2 => player.update(FollowSlot::Main, RUN, full_update()),
                3 => player.update(FollowSlot::Compared, OTHER_RUN, full_update()),
                4 => player.condition(Condition::Died, None),
                5 => player.condition(Condition::InPhase(Phase::Finished), None),
                6 => player.report(trainer_failed(None, "it failed")),
                7 => player.has_policy(true),
                _ => player,
            };
            player.app.tick(0.7);
            if news > 9 {
                player.picture(width, height);
            }
        }
        player.picture(width, height);
    }
}
