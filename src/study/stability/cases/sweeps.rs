//! Large numbers of random and adversarial shots.

use super::{Case, CaseKind};
use crate::{
    study::stability::{Generator, adversarial, random},
    table::Table,
};

const fn case(name: &'static str, tables: fn() -> Vec<Table>, shot: Generator, kind: CaseKind) -> Case {
    Case::new(name, tables, shot).of_kind(kind)
}

pub const CASES: &[Case] = &[
    case("random shots, table \"match\"", || preset("match"), random::shot, CaseKind::Random),
    case("random shots, table \"textbook\"", || preset("textbook"), random::shot, CaseKind::Random),
    case("random shots, table \"thesis\"", || preset("thesis"), random::shot, CaseKind::Random),
    case("adversarial shots, table \"match\"", || preset("match"), adversarial::shot, CaseKind::Adversarial),
    case("adversarial shots, table \"textbook\"", || preset("textbook"), adversarial::shot, CaseKind::Adversarial),
    case("adversarial shots, table \"thesis\"", || preset("thesis"), adversarial::shot, CaseKind::Adversarial),
];

fn preset(name: &str) -> Vec<Table> {
    Table::preset(name).into_iter().collect()
}
