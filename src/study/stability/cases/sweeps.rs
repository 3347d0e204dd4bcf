//! Shots of every kind, by the million.

use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, Size};
use crate::{
    study::stability::{Limits, Shot, adversarial, random},
    table::Table,
};

const fn case(
    name: &'static str,
    tables: fn() -> Vec<Table>,
    shot: fn(&Table, &mut Xoshiro256PlusPlus) -> Shot,
    size: Size,
) -> Case {
    Case { name, holds: "", tables, shot, check: None, limits: Limits::STRICT, size }
}

pub const CASES: &[Case] = &[
    case("random shots, table \"match\"", match_table, random::shot, Size::Random),
    case("random shots, table \"textbook\"", textbook_table, random::shot, Size::Random),
    case("random shots, table \"thesis\"", thesis_table, random::shot, Size::Random),
    case("adversarial shots, table \"match\"", match_table, adversarial::shot, Size::Adversarial),
    case("adversarial shots, table \"textbook\"", textbook_table, adversarial::shot, Size::Adversarial),
    case("adversarial shots, table \"thesis\"", thesis_table, adversarial::shot, Size::Adversarial),
];

fn match_table() -> Vec<Table> {
    Table::preset("match").into_iter().collect()
}

fn textbook_table() -> Vec<Table> {
    Table::preset("textbook").into_iter().collect()
}

fn thesis_table() -> Vec<Table> {
    Table::preset("thesis").into_iter().collect()
}
