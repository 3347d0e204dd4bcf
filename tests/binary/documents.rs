//! Tables, settings, shell completions and manual pages through the real binary; their descriptions in `docs/`; the animation.

#[path = "../../examples/picture/animation.rs"]
mod animation;
#[path = "../../examples/picture/svg.rs"]
#[allow(dead_code, reason = "still pictures are drawn by the example alone")]
mod svg;

use std::collections::BTreeSet;

use animation::{Frame, moving_picture};
use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Style},
};

use crate::program::{carom, run, stdout};

fn stderr(args: &[&str], code: i32) -> String {
    let output = run(args);
    assert_eq!(output.code, Some(code), "{}", output.err);
    output.err
}

#[test]
fn the_output_of_table_show_is_a_valid_table_file() {
    assert_eq!(stdout(&["table"]), stdout(&["table", "list"]));
    assert_eq!(stdout(&["table", "list", "--json"]).lines().count(), 3);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let file = file.to_str().unwrap();
    let shown = stdout(&["table", "show", "match"]);
    std::fs::write(file, shown.replace("name = \"match\"", "name = \"mine\"")).unwrap();
    assert!(stdout(&["table", "check", file]).contains("mine: 2.84 x 1.42 m"));
    assert!(stdout(&["simulate", "--table", file, "--shot", "0,0,0,0,2"]).contains("all still after"));
    assert_eq!(stderr(&["table", "check", file], 0), "");
    std::fs::write(file, shown.replace("model = \"smooth\"", "model = \"equator\"")).unwrap();
    let notes = stderr(&["table", "check", file], 0);
    assert!(notes.contains("rail.height has no effect") && notes.contains("rail.kappa has no effect"), "{notes}");
}

#[test]
fn table_check_names_the_invalid_value() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.toml");
    let name = file.to_str().unwrap();
    assert!(stderr(&["table", "check", name], 1).contains("bad.toml"));
    std::fs::write(&file, stdout(&["table", "show", "textbook"]).replace("e_rail = 0.85", "e_rail = 1.5")).unwrap();
    let message = stderr(&["table", "check", name], 2);
    assert!(
        message.contains("e_rail = 1.5") && message.contains("0 to 1") && message.contains("bad.toml"),
        "{message}"
    );
    assert!(stderr(&["table", "show", "snooker"], 1).contains("snooker"));
}

#[test]
fn a_users_table_is_listed_and_found_by_name() {
    let home = tempfile::tempdir().unwrap();
    let tables = home.path().join("carom/tables");
    std::fs::create_dir_all(&tables).unwrap();
    let shown = stdout(&["table", "show", "match"]);
    std::fs::write(tables.join("mine.toml"), &shown).unwrap();
    std::fs::write(tables.join("bad.toml"), "L = 0").unwrap();
    let listed = carom(home.path(), &["table", "list"]).ok();
    assert!(listed.out.contains("mine: 2.84 x 1.42 m") && listed.out.lines().count() == 4, "{}", listed.out);
    assert!(listed.err.starts_with("note: ") && listed.err.contains("bad.toml"), "{}", listed.err);
    carom(home.path(), &["simulate", "--table", "mine", "--shot", "0,0,0,0,2"]).ok();
    assert!(
        stderr(&["simulate", "--table", "yours", "--shot", "0,0,0,0,2"], 1).contains("one of your own by its name")
    );
}

#[test]
fn every_shell_has_completions() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&["completions", shell]);
        assert!(script.contains("recommend") && script.contains("budget-ms"), "{shell}");
        let has_values = ["bash", "fish", "zsh"].contains(&shell);
        assert!(
            !has_values || ["three-cushion", "world-class", "gather"].iter().all(|word| script.contains(word)),
            "{shell}"
        );
    }
    let fixed = ["q-learning", "thesis-ddpg", "future-work", "full none", "make miss undo"];
    let script = stdout(&["completions", "bash"]);
    assert!(fixed.iter().all(|words| script.contains(words)), "{script}");
    assert!(stderr(&["completions", "tcsh"], 2).contains("bash"));
}

#[test]
fn there_is_a_manual_page_for_the_program_and_every_subcommand() {
    assert!(stdout(&["man"]).contains("carom\\-recommend(1)"), "{}", stdout(&["man"]));
    assert!(stdout(&["man", "recommend"]).contains("budget\\-ms"));
    assert!(stdout(&["man", "table", "check"]).contains("TOML"));
    for page in [&["man"][..], &["man", "drill"], &["man", "drill", "list"]] {
        let page = stdout(page);
        assert!(page.contains(&format!(" {}", env!("CARGO_PKG_VERSION"))) && page.contains(".SH VERSION"), "{page}");
        assert!(!page.contains("help(1)") && !page.contains("docs/"), "no page or file that may be missing: {page}");
    }
    assert!(stderr(&["man", "simulate", "recommend"], 2).contains("\"carom simulate\" has no subcommands"));
    let message = stderr(&["man", "snooker"], 2);
    assert!(message.contains("snooker") && message.contains("recommend"), "{message}");
}

#[test]
fn packages_get_a_manual_page_for_every_subcommand_and_the_completions() {
    let folder = tempfile::tempdir().unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/.github/scripts/documents.sh");
    let (program, out) = (assert_cmd::cargo::cargo_bin!("carom"), folder.path().join("documents"));
    assert!(std::process::Command::new("bash").arg(script).arg(program).arg(&out).status().unwrap().success());
    let help = stdout(&["--help"]);
    let pages = subcommands(&help).into_iter().map(|(name, _)| format!("man/carom-{name}.1"));
    let others = ["man/carom.1", "completions/carom.bash", "completions/_carom", "completions/carom.fish"];
    for file in pages.chain(others.map(str::to_owned)) {
        let bytes = std::fs::metadata(out.join(&file)).unwrap_or_else(|error| panic!("{file}: {error}")).len();
        assert!(bytes > 100, "{file} has {bytes} bytes");
    }
}

#[test]
fn the_output_of_config_is_a_valid_settings_file() {
    let home = tempfile::tempdir().unwrap();
    let config = |args: &[&str]| carom(home.path(), args);
    let path = config(&["config", "--path"]).out;
    let path = std::path::Path::new(path.trim());
    assert!(path.starts_with(home.path()));
    let shown = config(&["config"]).out;
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, &shown).unwrap();
    config(&["config", "--check"]).ok();
    assert_eq!(config(&["config"]).out, shown);
    std::fs::write(path, "theme = \"light\"\nspeed = 80\n").unwrap();
    config(&["config", "--check"]).fails(2, &["line 2: speed = 80; accepted is 0.1, 0.25"]);
    assert!(config(&["config"]).out.contains("theme = \"light\""));
}

#[test]
fn the_settings_page_matches_the_output_of_config() {
    let home = tempfile::tempdir().unwrap();
    let shown = carom(home.path(), &["config"]).out;
    let mut rows = vec!["| key | what it means | accepted | default |\n|---|---|---|---|".to_owned()];
    let mut note = Vec::new();
    for line in shown.lines().take_while(|&line| line != "[keys]") {
        if let Some(words) = line.strip_prefix("# ") {
            note.push(words);
        } else if let Some((key, _)) = line.split_once(" = ") {
            let comment = note.join(" ");
            let (meaning, values) = comment.split_once(" Accepted: ").unwrap();
            let (accepted, default) = values.trim_end_matches('.').split_once(". Default: ").unwrap();
            rows.push(format!("| `{key}` | {meaning} | {accepted} | `{default}` |"));
            note.clear();
        } else {
            note.clear();
        }
    }
    assert!(rows.len() > 10, "{rows:?}");
    let table = rows.join("\n") + "\n";
    assert!(include_str!("../../docs/settings.md").contains(&table), "docs/settings.md needs this table:\n{table}");
}

/// Returns the subcommands of the program or of one of them, each with the first sentence of its description.
fn subcommands(help: &str) -> Vec<(&str, &str)> {
    let list = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    // Continuation lines are indented further.
    list.lines()
        .filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' '))?.split_once(' '))
        .map(|(name, about)| (name, about.trim().split(". ").next().unwrap()))
        .filter(|&(name, _)| name != "help")
        .collect()
}

/// Returns the long options in `words`: those that start after a space or a backtick.
fn options(words: &str) -> BTreeSet<&str> {
    let ends =
        |rest: &str| rest.find(|letter: char| !letter.is_ascii_lowercase() && letter != '-').unwrap_or(rest.len());
    words
        .match_indices("--")
        .filter(|&(at, _)| {
            words[..at].ends_with([' ', '`']) && words[at + 2..].starts_with(|letter: char| letter.is_ascii_lowercase())
        })
        .map(|(at, _)| &words[at..at + 2 + ends(&words[at + 2..])])
        .collect()
}

#[test]
fn the_command_line_page_lists_exactly_the_existing_options() {
    let page = include_str!("../../docs/command-line.md");
    let help = stdout(&["--help"]);
    let commands = subcommands(&help);
    let rows: Vec<String> = commands.iter().map(|(name, about)| format!("| `carom {name}` | {about} |")).collect();
    let table = rows.join("\n") + "\n";
    assert!(page.contains(&table), "docs/command-line.md needs this table:\n{table}");
    for (name, _) in commands {
        let (_, section) =
            page.split_once(&format!("\n## carom {name}\n")).unwrap_or_else(|| panic!("{name} has no section"));
        let section = section.split("\n## ").next().unwrap();
        let mut help = stdout(&["help", name]);
        if name == "drill" {
            let all: Vec<String> = subcommands(&help).iter().map(|(drill, _)| stdout(&["help", name, drill])).collect();
            help = all.concat();
        }
        let names = |line: &str| {
            line.split(|letter: char| !letter.is_ascii_lowercase() && letter != '-').next().map(str::to_owned)
        };
        let listed = help.lines().map(str::trim_start).filter(|line| line.starts_with("--"));
        let listed: BTreeSet<String> = listed.filter_map(names).collect();
        let listed: BTreeSet<&str> = listed.iter().map(String::as_str).collect();
        assert_eq!(options(section), listed, "section \"carom {name}\" of docs/command-line.md");
    }
}

#[test]
fn the_command_line_page_names_every_json_field() {
    let home = tempfile::tempdir().unwrap();
    let page = include_str!("../../docs/command-line.md");
    let entries = "[[trial]]\ntest = \"lag\"\nstop = 3.2\n";
    std::fs::write(home.path().join("entries.toml"), entries).unwrap();
    for line in [
        "simulate --rule straight --shot 0,0.3,0,1,4",
        "simulate --shot 0,0.3,0,1,4 --method steps --dt 0.01",
        "recommend --skill club --plan --margins --simulations 100",
        "recommend --policy-only",
        "evaluate --policy-only --layouts 5 --skill club",
        "evaluate --random-search 5 --layouts 5",
        "evaluate --self-play --layouts 1 --simulations 100 --skill beginner",
        "drill list",
        "drill show half-ball",
        "play --coach --innings 1 --strokes 2 --budget-ms 50",
        "play --against-coach --innings 1 --strokes 2 --budget-ms 50",
        "doctor",
        "accuracy --quick --shots 8 --table match",
        "calibrate --tests",
        "calibrate --simulate 1",
        "calibrate entries.toml",
    ] {
        let name = line.split(' ').next().unwrap();
        let section =
            page.split_once(&format!("\n## carom {}\n", if name == "play" { "drill" } else { name })).unwrap().1;
        let section = section.split("\n## ").next().unwrap();
        let answers = carom(home.path(), &line.split(' ').chain(["--json"]).collect::<Vec<_>>()).ok().json();
        for answer in &answers {
            for field in answer.as_object().unwrap().keys().filter(|field| name != "drill" || !is_of_an_exercise(field))
            {
                assert!(section.contains(&format!("`{field}`")), "carom {line}: {field}");
            }
        }
        assert!(!answers.is_empty(), "carom {line}");
    }
}

/// Fields of an exercise, which are documented with the library files.
fn is_of_an_exercise(field: &str) -> bool {
    ["name", "category", "grade", "point", "tags", "shot"].contains(&field)
}

#[test]
fn the_examples_in_the_docs_work() {
    let pages = [
        include_str!("../../README.md"),
        include_str!("../../docs/practice.md"),
        include_str!("../../docs/command-line.md"),
    ];
    // Only examples that take no time, need no file of the reader and store nothing.
    let examples = pages.iter().flat_map(|page| page.lines()).filter(|line| {
        ["carom simulate ", "carom drill list "].iter().any(|begin| line.starts_with(begin))
            && !line.contains("--batch")
    });
    let mut count = 0;
    for example in examples {
        let words = example.split('#').next().unwrap().trim();
        // Text between quotation marks is one word.
        let words = words
            .split('"')
            .enumerate()
            .flat_map(|(n, part)| if n % 2 == 1 { vec![part] } else { part.split_whitespace().collect() });
        let words: Vec<&str> = words.skip(1).collect();
        let answer = run(&words);
        assert_eq!(answer.code, Some(0), "{example}: {}", answer.err);
        count += 1;
    }
    assert!(count >= 5, "{count} examples");
}

/// Panics unless every element of `document` is closed in order and every attribute is quoted.
fn check_elements(document: &str) {
    let mut open = Vec::new();
    for rest in document.split('<').skip(1) {
        let (tag, text) = rest.split_once('>').unwrap_or_else(|| panic!("no end: <{rest}"));
        assert!(!text.contains('>'), "a bare >: {text}");
        assert_eq!(tag.matches('"').count() % 2, 0, "<{tag}>");
        let name = |tag: &str| tag.split([' ', '/']).next().unwrap().to_owned();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(closed));
        } else if !tag.ends_with('/') {
            open.push(name(tag));
        }
    }
    assert!(open.is_empty(), "never closed: {open:?}");
}

fn screen(rows: [&str; 2]) -> Buffer {
    let mut screen = Buffer::empty(Rect::new(0, 0, 8, 2));
    screen.set_style(screen.area, Style::new().fg(Color::Rgb(255, 255, 255)).bg(Color::Rgb(1, 2, 3)));
    for (row, words) in (0..).zip(rows) {
        screen.set_string(0, row, words, Style::new());
    }
    screen
}

#[test]
fn the_animation_repaints_only_changed_cells() {
    let frame = |rows, seconds| Frame { screen: screen(rows), seconds };
    let frames =
        [frame(["ab", "table"], 1.0), frame(["ab", "tab<e"], 0.5), frame(["ab", "tab<e"], 0.5), frame(["x", ""], 2.0)];
    let picture = moving_picture(&frames, 1, "a title");
    check_elements(&picture);
    let layers: Vec<&str> = picture.split("<g id=\"f").collect();
    assert_eq!(layers.len(), 4);
    assert!(layers[0].contains(">ab<") && layers[0].contains(">table<"));
    // The letters next to the changed one are painted, too, because letters may extend into neighbouring cells.
    assert!(
        layers[1].starts_with("1\">") && layers[1].contains(">b&lt;e<") && !layers[1].contains("ab"),
        "{}",
        layers[1]
    );
    assert!(layers[2].starts_with("2\" visibility=\"hidden\">") && !layers[2].contains("<text"), "{}", layers[2]);
    assert!(layers[3].contains(">x<"), "{}", layers[3]);
    for (layer, percent) in [(1, "25.000"), (2, "37.500"), (3, "50.000")] {
        assert!(
            picture.contains(&format!(
                "@keyframes f{layer}{{0%{{visibility:hidden}}{percent}%,to{{visibility:visible}}}}"
            ))
        );
        assert!(picture.contains(&format!("#f{layer}{{animation:f{layer} 4.000s step-end infinite}}")));
    }
}

#[test]
fn the_readme_animation_is_small_and_self_contained() {
    let picture = include_str!("../../docs/coach-moving.svg");
    check_elements(picture);
    assert!(picture.len() < 250_000, "{} bytes", picture.len());
    for foreign in ["<script", "href", "url(", "@import", "<foreignObject"] {
        assert!(!picture.contains(foreign), "{foreign}");
    }
    assert!(picture.contains("@media (prefers-reduced-motion:no-preference)"));
    // The still frame shows the coach's advice.
    let still = picture.split(" visibility=\"hidden\"").next().unwrap();
    assert!(still.contains("expert makes it") && !still.contains("plays the shot"));
    assert!(picture.contains("the point is made"));
    assert!(include_str!("../../README.md").contains("](docs/coach-moving.svg)"));
}

#[test]
fn the_still_pictures_are_well_formed() {
    for picture in [
        include_str!("../../docs/coach.svg"),
        include_str!("../../docs/coach-80x24.svg"),
        include_str!("../../docs/help.svg"),
        include_str!("../../docs/training.svg"),
        include_str!("../../docs/training-80x24.svg"),
    ] {
        check_elements(picture);
    }
}
