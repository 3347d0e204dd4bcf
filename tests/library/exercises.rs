//! The bundled exercises: each can be played, and its shot shows what it teaches.

use std::{collections::HashSet, fs, path::Path};

use carom::{
    coach::{
        PATTERNS, Pattern, Skill, Technique,
        systems::{Guide, Line, System, diamonds, guide, metres},
    },
    drills::{Category, Exercise, Library, LibraryFile, MAX_GATHERED_DISTANCE, Par, decode, encode, flaws, shifted},
    game::scores,
    physics::CueInputs,
    simulation::Recording,
    statistics::normal_pair,
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

fn bundled() -> Vec<Exercise> {
    Library::bundled().exercises().to_vec()
}

#[test]
fn every_category_has_enough_exercises_with_complete_texts() {
    let exercises = bundled();
    assert!(exercises.len() >= 72, "{}", exercises.len());
    for category in Category::ALL {
        let of_it: Vec<u8> = exercises.iter().filter(|e| e.category == category).map(|e| e.grade).collect();
        let least = if category == Category::Own { 0 } else { 9 };
        assert!(of_it.len() >= least && (least > 0 || of_it.is_empty()), "{category}: {}", of_it.len());
        assert!(of_it.is_sorted(), "{category} goes from easy to hard: {of_it:?}");
    }
    for grade in 1..=5 {
        assert!(exercises.iter().filter(|e| e.grade == grade).count() >= 5, "grade {grade}");
    }
    let names: HashSet<&str> = exercises.iter().map(|e| e.name.as_str()).collect();
    let titles: HashSet<&str> = exercises.iter().map(|e| e.title.as_str()).collect();
    assert_eq!((names.len(), titles.len()), (exercises.len(), exercises.len()));
    for Exercise { name, point, title, tags, .. } in &exercises {
        assert!(!title.is_empty() && title.len() <= 40, "{name}: {title}");
        assert!(point.len() >= 40 && point.len() <= 240 && point.ends_with('.'), "{name}: {point}");
        assert!(!tags.is_empty(), "{name}");
    }
}

#[test]
fn every_shot_shows_what_its_category_teaches() {
    let exercises = bundled();
    for exercise in &exercises {
        assert_eq!(flaws(exercise).unwrap(), Vec::<&str>::new(), "{}", exercise.name);
        assert!(exercise.shot.is_some(), "{}", exercise.name);
    }
    let turns = |exercise: &&Exercise| {
        let table = exercise.table().unwrap();
        Technique::of(&table, &exercise.layout, &exercise.shot.unwrap()).unwrap().deflection.to_degrees() > 90.0
    };
    let draws = exercises.iter().filter(|e| e.category == Category::Draw);
    assert!(draws.filter(turns).count() >= 6);
}

/// In exercises for gathering, the tags describe the motion of yellow; in one-cushion exercises, the tags `draw`, `follow` and `thin`
/// describe the stroke.
#[test]
fn the_pattern_classifier_agrees_with_exercise_tags() {
    let mut compared = 0;
    for exercise in bundled().into_iter().filter(|exercise| exercise.category != Category::Gather) {
        let table = exercise.table().unwrap();
        let technique = Technique::of(&table, &exercise.layout, &exercise.shot.unwrap()).unwrap();
        let named = Pattern::of(&technique).unwrap();
        let is_stroke =
            |tag: &str| exercise.category == Category::OneCushion && ["draw", "follow", "thin"].contains(&tag);
        let is_pattern = |tag: &&str| PATTERNS.iter().any(|pattern| pattern.tag == *tag) && !is_stroke(tag);
        let mut wanted: Vec<&str> = exercise.tags.iter().map(String::as_str).filter(is_pattern).collect();
        match exercise.category {
            Category::Draw => wanted = vec!["draw"],
            Category::Follow => wanted = vec!["follow"],
            _ => {}
        }
        compared += usize::from(!wanted.is_empty());
        assert!(wanted.is_empty() || wanted.contains(&named.tag), "{} {wanted:?}: {named:?}", exercise.name);
    }
    assert!(compared >= 65, "{compared}");
}

#[test]
fn the_numbers_in_system_exercises_match_their_shots() {
    for exercise in bundled().into_iter().filter(|exercise| exercise.category == Category::Systems) {
        let (table, shot) = (exercise.table().unwrap(), exercise.shot.unwrap());
        let recording = Recording::new(&table, &exercise.layout, &shot).unwrap();
        let Some(Guide::System(applied)) = guide(&table, &recording) else { panic!("{}", exercise.name) };
        // The text of the exercise and the text of the coach: three numbers with a sign and an equals sign.
        let [stated, counted] = [&exercise.point, &applied.arithmetic()].map(|text| {
            let words: Vec<&str> = text.split([' ', ',', ':']).collect();
            let equals = words.iter().position(|word| *word == "=").unwrap();
            [3, 1].map(|back| words[equals - back]).map(|word| word.parse::<f64>().unwrap())
        });
        // A tenth of a diamond, or three tenths for systems in which one unit is a diamond or less.
        let near = if applied.system == System::Corner5 { 1.0 } else { 0.3 };
        for (stated, counted) in stated.into_iter().zip(counted) {
            assert!((stated - counted).abs() <= near, "{}: {}", exercise.name, applied.arithmetic());
        }
    }
}

/// [`flaws`] checks the line of the ball itself. A player who aims the cue through the stated diamond and ignores squirt must also make the
/// point.
#[test]
fn aiming_at_the_number_of_a_system_exercise_scores() {
    for exercise in bundled().into_iter().filter(|exercise| exercise.category == Category::Systems) {
        let (table, shot) = (exercise.table().unwrap(), exercise.shot.unwrap());
        let system = System::ALL.into_iter().find(|system| exercise.tags[0] == system.name().to_lowercase()).unwrap();
        let stated = exercise.point.split_once("= ").unwrap().1.split([' ', ',', ':']).next().unwrap();
        let stated: f64 = stated.parse().unwrap();
        let from = diamonds(&table, exercise.layout.balls[0]);
        let [low, high] = system.first_ends();
        let lines = (0..=8000).map(|step| low + (high - low) * f64::from(step) / 8000.0);
        let off = |line: &Line| system.numbers(line).map_or(f64::INFINITY, |numbers| (numbers.first - stated).abs());
        let lines = lines.map(|along| Line::between(from, system.first_at(along)));
        let line = lines.min_by(|one, other| off(one).total_cmp(&off(other))).unwrap();
        assert!(off(&line) < 0.02, "{}: {line:?}", exercise.name);
        let phi = (metres(&table, from + line.direction) - metres(&table, from)).to_angle();
        assert!(scores(exercise.rule, &table, &exercise.layout, &CueInputs { phi, ..shot }), "{}", exercise.name);
    }
}

#[test]
fn gather_exercises_work_with_an_experts_errors() {
    for exercise in bundled().into_iter().filter(|exercise| exercise.category == Category::Gather) {
        let (table, shot) = (exercise.table().unwrap(), exercise.shot.unwrap());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let gathered = |errors: &[f64; 5]| {
            let stroke = Skill::EXPERT.stroke(table.radius, &shot, errors);
            let technique = Technique::of(&table, &exercise.layout, &stroke).unwrap();
            technique.tally.is_point(exercise.rule) && technique.spread <= MAX_GATHERED_DISTANCE
        };
        let mut errors = || {
            let [[a, b], [theta, phi], [speed, _]] = std::array::from_fn(|_| normal_pair(&mut rng));
            [a, b, theta, phi, speed]
        };
        let times = (0..200).filter(|_| gathered(&errors())).count();
        assert!(times >= 120, "{}: {times} of 200", exercise.name);
    }
}

#[test]
fn a_shot_that_misses_its_exercises_purpose_is_detected() {
    let library = Library::bundled();
    let changed = |category, change: fn(&mut CueInputs)| {
        let exercise = library.exercises().iter().find(|e| e.category == category).unwrap();
        let mut exercise = exercise.clone();
        change(exercise.shot.as_mut().unwrap());
        flaws(&exercise).unwrap()
    };
    assert!(changed(Category::Draw, |cue| cue.b = 0.0).contains(&"the tip is more than 0.2 R below the centre"));
    assert!(changed(Category::Side, |cue| cue.a = 0.0).contains(&"it makes the point by its rule"));
    assert!(
        changed(Category::FirstCaroms, |cue| cue.phi += 3.0).contains(&"it hits yellow first, or red in the opening")
    );
    let mut named_otherwise = library.get("umbrella").unwrap().clone();
    named_otherwise.tags = vec!["natural".to_owned()];
    assert_eq!(flaws(&named_otherwise).unwrap(), ["the course is the pattern's"]);
}

#[test]
fn par_equals_its_measurement_and_determines_the_grade() {
    let exercises = bundled();
    for exercise in &exercises {
        let par = exercise.par.unwrap();
        assert_eq!(exercise.grade, par.grade(), "{}", exercise.name);
        // A beginner who misses the intended shot still makes some points by luck. If a stroke is equally likely for two players, the
        // random spread of the attempts decides.
        let is_ordered = par.beginner <= par.club + 0.01 && par.club <= par.world_class;
        assert!(is_ordered, "{}: {par:?}", exercise.name);
    }
    // All exercises are checked by the example `grade` with --check.
    for exercise in exercises.iter().step_by(19) {
        assert_eq!(Par::measure(exercise).unwrap(), exercise.par, "{}", exercise.name);
    }
}

#[test]
fn the_library_files_are_formatted_by_the_program() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    for category in Category::ALL.into_iter().filter(|category| *category != Category::Own) {
        let text = fs::read_to_string(folder.join(format!("{category}.json"))).unwrap();
        let file = LibraryFile::parse(&text).unwrap();
        assert!(file.exercises.iter().all(|exercise| exercise.category == category));
        assert_eq!(file.to_text().unwrap(), text, "{category}");
    }
}

#[test]
fn every_exercise_can_be_shared_and_shifted() {
    for exercise in bundled() {
        let code = encode(&exercise).unwrap();
        let shared = decode(&code).unwrap();
        let table = shared.table().unwrap();
        assert_eq!((shared.layout, shared.rule, &shared.title), (exercise.layout, exercise.rule, &exercise.title));
        assert_eq!(shared.tags, exercise.tags);
        assert!(scores(shared.rule, &table, &shared.layout, &shared.shot.unwrap()), "{}", exercise.name);
        assert!(code.len() <= 200, "{}: {}", exercise.name, code.len());
        for repetition in 1..10 {
            let moved = shifted(&exercise.layout, &table, 1, repetition);
            moved.validate(&table).unwrap();
            assert_ne!(moved, exercise.layout);
        }
    }
}
