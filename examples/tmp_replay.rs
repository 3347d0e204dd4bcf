//! Scratch: replay of findings.
use carom::{
    physics::{CueInputs, strike},
    simulation::{Event, Observer, simulate},
    table::{Layout, Table},
};
use glam::DVec2;
use std::{ops::ControlFlow, time::Instant};
struct Count(usize, bool);
impl Observer for Count {
    fn event(&mut self, e: Event) -> ControlFlow<()> {
        self.0 += 1;
        if self.1 && self.0 < 400 {
            println!("{:.15} {:?}", e.time, e.kind);
        }
        if self.0 > 3000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let only: Option<usize> = args.get(2).map(|s| s.parse().unwrap());
    let v = std::env::var("V").is_ok();
    let (mut n, mut many, mut slow, mut tot) = (0, 0, 0, 0.0);
    for (i, line) in std::fs::read_to_string(&args[1]).unwrap().lines().enumerate() {
        if only.is_some_and(|o| o != i) {
            continue;
        }
        let d: serde_json::Value = serde_json::from_str(line).unwrap();
        let table = Table::preset(d["table"].as_str().unwrap()).unwrap();
        let p = |k: usize| DVec2::new(d["layout"][k][0].as_f64().unwrap(), d["layout"][k][1].as_f64().unwrap());
        let layout = Layout::new([p(0), p(1), p(2)]);
        let c = &d["cue"];
        let cue: CueInputs = serde_json::from_value(c.clone()).unwrap();
        if v {
            eprint!("{i} ");
        }
        let t = Instant::now();
        let mut o = Count(0, only.is_some());
        simulate(&table, &layout, &strike(&table, &cue), &mut o);
        let ms = t.elapsed().as_secs_f64() * 1e3;
        n += 1;
        tot += ms;
        if o.0 > 400 {
            many += 1;
            println!("{i} {} events {} was {} ms {ms:.1}", d["table"], o.0, d["events"]);
        }
        if ms > 50.0 {
            slow += 1;
            println!(
                "{i} {} slow {ms:.1} was {} events {} was {} {}",
                d["table"], d["ms"], o.0, d["events"], d["what"]
            );
        }
    }
    println!("{n} shots, {many} > 400 events, {slow} slow, {tot:.0} ms");
}
