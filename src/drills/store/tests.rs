//! Tests that saved data is read back, and that unreadable files are left unchanged.

use super::*;
use crate::{
    coach::Skill,
    drills::{
        Goal,
        session::tests::{exercise, session},
    },
};

fn store(folder: &tempfile::TempDir) -> Store {
    let at = |name: &str| folder.path().join(name);
    Store { sessions: at("sessions"), positions: at("positions"), player: at("player.json") }
}

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    fs::create_dir_all(folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn session_file_follows_added_and_undone_attempts() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    assert!(store.sessions().items.is_empty() && store.sessions().notes.is_empty(), "nobody has practised yet");
    let mut session = session(Goal::Free, "x");
    for _ in 0..3 {
        store.save(&session, &session.attempts[..session.attempts.len() - 1], 0).unwrap();
        session.log(false).unwrap();
    }
    let before = session.attempts.clone();
    session.undo();
    session.undo();
    store.save(&session, &before, 0).unwrap();
    assert_eq!(store.sessions().items, [session]);
    let files = fs::read_dir(&store.sessions).unwrap().filter(|file| file.as_ref().unwrap().file_name() != Lock::FILE);
    assert_eq!(files.count(), 1);
}

#[test]
fn changes_by_another_program_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let known = session(Goal::Run(9), "x");
    store.save(&known, &[], 0).unwrap();
    let [mut here, mut there] = [(); 2].map(|()| known.clone());
    there.log(true).unwrap();
    store.save(&there, &known.attempts, 0).unwrap();
    // An equal number of attempts with the same visible content still are two different attempts.
    here.attempts.push(there.attempts[1].clone());
    here.log(false).unwrap();
    let mut shorter = known.clone();
    shorter.undo();
    for refused in [&here, &shorter] {
        match store.save(refused, &known.attempts, 0) {
            Err(StoreError::Changed(stored)) => assert_eq!(*stored, there),
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(store.sessions().items, [there.clone()]);
    // Attempts that could not be written before are written with the next one, and a changed evaluation of a stroke is
    // no conflict.
    let mut ahead = there.clone();
    ahead.attempts[0].chance = Some(0.5);
    ahead.log(true).unwrap();
    let before = ahead.attempts.clone();
    ahead.log(false).unwrap();
    store.save(&ahead, &before, 2).unwrap();
    assert_eq!(store.sessions().items, [ahead.clone()]);
    // Attempts that another program has removed do not reappear.
    let mut shorter = ahead.clone();
    shorter.undo();
    store.save(&shorter, &ahead.attempts, 4).unwrap();
    let before = ahead.attempts.clone();
    ahead.log(true).unwrap();
    assert!(matches!(store.save(&ahead, &before, 4), Err(StoreError::Changed(stored)) if *stored == shorter));
}

#[test]
fn newer_and_damaged_files_are_reported_and_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let session = session(Goal::Free, "x-");
    store.save(&session, &[], 0).unwrap();
    let path = file(&store.sessions, &session.id).unwrap();
    let text = fs::read_to_string(&path).unwrap().replace("\"version\":1", "\"version\":2");
    fs::write(&path, &text).unwrap();
    write(&store.sessions, "half.json", &text[..text.len() / 2]);
    write(&store.sessions, "notes.txt", "not ours");
    let found = store.sessions();
    assert_eq!((found.items.len(), found.notes.len()), (0, 2), "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("version 2") && note.contains("newer")), "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("half.json") && note.contains("damaged")), "{:?}", found.notes);
    assert!(store.save(&session, &session.attempts, 0).is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), text);

    let newer = write(&store.positions, "mine.json", r#"{"format":"carom-library","version":2,"exercises":3}"#);
    for refused in [store.save_position(&exercise("mine"), true), store.remove_position("mine")] {
        assert!(refused.unwrap_err().to_string().contains("version 2"));
    }
    assert!(fs::read_to_string(newer).unwrap().contains("\"version\":2"));
    write(folder.path(), "player.json", r#"{"format":"carom-player","version":9}"#);
    assert!(store.save_skill(Skill::CLUB).unwrap_err().to_string().contains("version 9"));
}

#[test]
fn position_is_replaced_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    store.save_position(&exercise("mine"), false).unwrap();
    let other = Exercise { title: "Another".to_owned(), ..exercise("mine") };
    assert!(matches!(store.save_position(&other, false), Err(StoreError::NameTaken(_))));
    assert_eq!(store.positions().items[0].title, "mine");
    store.save_position(&other, true).unwrap();
    assert_eq!(store.positions().items, [Exercise { category: Category::Own, ..other }]);
    assert!(store.save_position(&exercise("../mine"), true).is_err());
    store.remove_position("mine").unwrap();
    assert!(matches!(store.remove_position("mine"), Err(StoreError::Unknown(_))));
}

#[test]
fn copied_file_under_another_name_is_reported_and_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let session = session(Goal::Free, "xx");
    store.save(&session, &[], 0).unwrap();
    fs::copy(file(&store.sessions, &session.id).unwrap(), store.sessions.join("copy.json")).unwrap();
    let found = store.sessions();
    assert!(found.items == [session] && found.notes[0].contains("copy.json"), "{:?}", found.notes);
}

#[test]
fn export_imports_once_and_the_longer_session_wins() {
    let [here, there] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let [here, there] = [&here, &there].map(store);
    let mut session = session(Goal::Free, "x");
    here.save(&session, &[], 0).unwrap();
    there.save(&session, &[], 0).unwrap();
    session.log(true).unwrap();
    here.save(&session, &session.attempts[..1], 0).unwrap();
    here.save_position(&exercise("mine"), false).unwrap();
    here.save_position(&exercise("ours"), false).unwrap();
    there.save_position(&Exercise { title: "Mine".to_owned(), ..exercise("mine") }, false).unwrap();
    here.save_skill(Skill::CLUB).unwrap();

    let (practice, notes) = here.export();
    assert!(notes.is_empty());
    let text = serde_json::to_string(&practice).unwrap();
    let practice = Practice::parse(&text).unwrap();
    let imported = there.import(&practice);
    let refused = vec![StoreError::NameTaken("mine".to_owned()).to_string()];
    assert_eq!(imported, Imported { positions: 1, longer: 1, refused, ..Imported::default() });
    assert_eq!(there.sessions().items, [session.clone()]);
    assert_eq!(there.own_skill().unwrap().unwrap().skill, Skill::CLUB);
    let again = there.import(&practice);
    assert_eq!((again.known, again.positions, again.longer, again.refused.len()), (2, 0, 0, 1));
    // In the other direction, the longer session here is not replaced by the shorter one.
    assert_eq!(here.import(&there.export().0).longer, 0);
    // If both have continued, neither is overwritten.
    let [mut mine, mut yours] = [(); 2].map(|()| session.clone());
    for (store, session, made) in [(&here, &mut mine, true), (&there, &mut yours, false)] {
        session.log(made).unwrap();
        session.log(made).unwrap();
        store.save(session, &session.attempts[..2], 2).unwrap();
    }
    yours.log(false).unwrap();
    there.save(&yours, &yours.attempts[..4], 4).unwrap();
    let refused = here.import(&there.export().0).refused;
    assert!(refused.iter().any(|one| one.contains("continued both here")), "{refused:?}");
    assert_eq!((here.sessions().items, there.sessions().items), (vec![mine], vec![yours]));
}

#[test]
fn imported_session_cannot_write_outside_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let stray = Session { id: "../player".to_owned(), ..session(Goal::Free, "x") };
    let mut practice = store.export().0;
    practice.sessions = vec![stray, Session { exercises: vec![exercise("second")], ..session(Goal::Free, "x") }];
    let imported = store.import(&practice);
    assert_eq!(imported.refused.len(), 2, "{imported:?}");
    assert!(imported.refused[0].contains("../player") && imported.refused[1].contains("\"first\""), "{imported:?}");
    assert!(!folder.path().join("player.json").exists());
    assert!(
        Practice::parse(&serde_json::to_string(&practice).unwrap().replace("\"version\":1", "\"version\":3")).is_err()
    );
}
