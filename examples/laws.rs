//! How far each law of the rails is to be believed after the film, with its own best constants: what the doubt about `match` says.
//!
//! `cargo run --release --example laws` fits every law to both halves of the film, weighs them by the rails that they predict of the
//! other half, and says what `src/table/match_doubt.toml` is made of. It takes some minutes.

use carom::{
    study::filmed::{bundled, weigh},
    table::{RailModel, Table},
};

/// The laws, that of `match` first.
const LAWS: [RailModel; 4] = [RailModel::Smooth, RailModel::Nose, RailModel::Mathavan, RailModel::Equator];

/// As many filmed meetings are taken to speak for all laws alike.
const SURE: f64 = 20.0;

fn main() {
    let table = Table::default();
    for law in weigh(&table, &LAWS, &bundled(), SURE) {
        let fitted = &law.fitted;
        println!(
            "# {:?}: misses the next rail by {:.3} diamonds (median of {})",
            fitted.model, law.median, law.predicted
        );
        println!("model = {:?}\nweight = {:.2}", fitted.model, law.weight);
        for constant in &fitted.constants {
            println!("{} = {:.5}, deviation {:.5}", constant.name, constant.value, constant.deviation);
        }
        for (row, line) in fitted.correlations.iter().enumerate() {
            for (column, value) in line.iter().enumerate().take(row).filter(|(_, value)| value.abs() > 0.3) {
                println!("[{:?}, {:?}, {value:.2}]", fitted.constants[column].name, fitted.constants[row].name);
            }
        }
        println!();
    }
}
