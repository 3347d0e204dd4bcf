//! If the locale has no UTF-8, text for people is transliterated to ASCII; JSON and text meant for a file are not.

use crate::program::{carom, command, folder, outcome};

#[test]
fn text_is_ascii_in_ascii_locales_and_json_is_unchanged() {
    let home = folder();
    let run = |args: &[&str], locale: &str| {
        let mut command = command(home.path(), args);
        outcome(command.env("LANG", locale).spawn().unwrap())
    };
    carom(home.path(), &["drill", "log", "mine", "make", "miss", "make"]);
    let tried = ["drill", "try", "mine", "--shot", "0,0.3,3,5,4", "--skill", "perfect", "--seed", "1"];
    let miscue = ["simulate", "--layout", "-0.5,0 0,0 0.5,0.03", "--shot", "0.6,0,5,1,2"];
    for (args, word, instead) in [
        (&tried[..], "aim right 4.70\u{b0}", "aim right 4.70 degrees"),
        (&miscue, "a\u{b2} + b\u{b2}", "a^2 + b^2"),
        (&["drill", "history", "mine"], "\u{2586}\u{2581}\u{2581}", "*.."),
        (&["drill", "show", "jump-red"], "", ""),
        (&["recommend", "--help"], "mass\u{e9}", "masse"),
        (&["recommend", "--rule", "mass\u{e9}"], "mass\u{e9}", "masse"),
    ] {
        let [fancy, plain] = ["C.UTF-8", "C"].map(|locale| run(args, locale)).map(|run| run.out + &run.err);
        assert!(fancy.contains(word), "{args:?}: {fancy}");
        assert!(plain.is_ascii() && plain.contains(instead), "{args:?}: {plain}");
    }
    for args in [&[&miscue[..], &["--json"]].concat()[..], &["config"], &["table", "show", "match"], &["man"]] {
        let [fancy, plain] = ["C.UTF-8", "C"].map(|locale| run(args, locale).out);
        assert_eq!(fancy, plain, "{args:?}");
    }
    let [fancy, plain] = ["C.UTF-8", "C"].map(|locale| run(&[&tried[..], &["--json"]].concat(), locale).json());
    assert!(fancy[1]["changes"][0].as_str().unwrap().contains('\u{b0}'), "{fancy:?}");
    assert_eq!(fancy[1]["changes"], plain[1]["changes"]);
    let mut own = command(home.path(), &tried);
    let own = outcome(own.env("LANG", "C").env("LC_ALL", "de_DE.UTF-8").spawn().unwrap());
    assert!(own.out.contains('\u{b0}'), "{}", own.out);
}
