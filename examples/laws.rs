//! Weight of each rail model according to the filmed shots, with its own fitted constants: the source of the doubt about `match`.
//!
//! `cargo run --release --example laws` fits every model to both halves of the film, weighs the models by their predictions of the rails in
//! the other half, and prints the content of `src/table/match_doubt.toml`. It takes a few minutes.

use carom::{
    study::filmed::{bundled, weigh_models},
    table::{RailModel, Table},
};

/// The rail models, that of `match` first.
const LAWS: [RailModel; 4] = [RailModel::Smooth, RailModel::Nose, RailModel::Mathavan, RailModel::Equator];

/// Pseudo-count: this many filmed contacts count as predicted equally well by all models.
const SURE: f64 = 20.0;

fn main() {
    let table = Table::default();
    for law in weigh_models(&table, &LAWS, &bundled(), SURE) {
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
