//! `carom reproduce` through the real binary.

use crate::program::{KillOnDrop, Outcome, home, run};

fn reproduce(args: &[&str]) -> Outcome {
    run(&[&["reproduce"], args].concat())
}

#[test]
fn a_figure_is_written_as_csv_and_svg_and_does_not_depend_on_threads() {
    let files = |jobs: &str| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let args = ["--figure", "23", "--figure", "25", "--episodes", "800", "--jobs", jobs, "--out", out];
        let text = reproduce(&args).ok().out;
        assert!(text.contains("Figure 23") && text.contains("random play"), "{text}");
        ["figure-23.csv", "figure-23.svg", "figure-25.csv", "figure-25.svg"]
            .map(|name| std::fs::read_to_string(folder.path().join(name)).unwrap())
    };
    let one = files("1");
    assert!(one[0].starts_with("curve,seed,shots,mean_reward,mean_q,loss\none shot,1,800,"), "{}", one[0]);
    assert!(one[0].contains("\n20 shots,1,200,") && one[0].contains("\nuntil a miss,1,200,"), "{}", one[0]);
    assert!(one[1].contains("</svg>") && one[3].contains("loss"), "{}", one[3]);
    assert_eq!(one, files("2"));
}

#[test]
fn an_unknown_figure_is_refused_with_the_available_ones() {
    let Outcome { code, err, .. } = reproduce(&["--figure", "26"]);
    assert_eq!((code, err.lines().count()), (Some(2), 1), "{err}");
    assert!(err.contains("26") && err.contains("q-learning, 21, 22"), "{err}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_reports_the_number_of_complete_figures() {
    let folder = tempfile::tempdir().unwrap();
    let child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("carom"))
        .envs(home())
        .args(["reproduce", "--figure", "29", "--episodes", "100000000", "--out"])
        .arg(folder.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut child = KillOnDrop(child);
    // The program reports that it trains once it handles signals.
    let mut messages = std::io::BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    std::io::BufRead::read_line(&mut messages, &mut line).unwrap();
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let mut rest = String::new();
    std::io::Read::read_to_string(&mut messages, &mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{line}{rest}");
    assert!(rest.contains("0 of 1 figures"), "{rest}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
