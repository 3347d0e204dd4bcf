//! Large numbers of random and adversarial shots.

use super::{Case, Size};
use crate::{
    study::stability::{Generator, adversarial, random},
    table::Table,
};

const fn case(name: &'static str, tables: fn() -> Vec<Table>, shot: Generator, size: Size) -> Case {
    Case::new(name, tables, shot).of_size(size)
}

pub const CASES: &[Case] = &[
    case("random shots, table \"match\"", || preset("match"), random::shot, Size::Random),
    case("random shots, table \"textbook\"", || preset("textbook"), random::shot, Size::Random),
    case("random shots, table \"thesis\"", || preset("thesis"), random::shot, Size::Random),
    case("adversarial shots, table \"match\"", || preset("match"), adversarial::shot, Size::Adversarial),
    case("adversarial shots, table \"textbook\"", || preset("textbook"), adversarial::shot, Size::Adversarial),
    case("adversarial shots, table \"thesis\"", || preset("thesis"), adversarial::shot, Size::Adversarial),
];

fn preset(name: &str) -> Vec<Table> {
    Table::preset(name).into_iter().collect()
}
