//! Files: where they are stored, and writing them without ever leaving half a file behind.

mod atomic;
mod confinement;
mod folder_state;
mod lines;
mod lock;
mod name;
mod notices;
mod places;
mod plain_words;
mod player;
mod reading;

pub use atomic::{
    Staged, create_atomic, remove_abandoned_files, remove_partial_files, replace, target_of, write_atomic,
};
pub use confinement::{confine, may_read};
pub use folder_state::{FolderState, folder_state};
pub use lines::{LONGEST_LINE, NextLine, next_line};
pub use lock::Lock;
pub use name::{LONGEST_NAME, NAME_RULE, is_letter, is_name};
pub use notices::notice;
pub use places::{Places, is_called};
pub use plain_words::{in_plain_words, json_flaw, toml_flaw, without_numbers};
pub use player::{Player, PlayerNameError};
pub use reading::{LARGE, PRACTICE, SMALL, open, put_aside, read, read_if_there, read_text};
