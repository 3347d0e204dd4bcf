//! Files: where they are stored, and writing them without ever leaving half a file behind.

mod atomic;
mod confinement;
mod data_paths;
mod folder_state;
mod lines;
mod lock;
mod name;
mod notices;
mod plain_words;
mod player;
mod reading;

pub use atomic::{
    StagedFile, create_atomic, remove_abandoned_files, remove_if_exists, remove_partial_files, resolve_symlinks,
    save_json, write_atomic, write_atomic_unsynced,
};
pub use confinement::{check_read_allowed, confine};
pub use data_paths::{DataPaths, has_name};
pub use folder_state::{FolderState, folder_state};
pub use lines::{MAX_LINE_BYTES, NextLine, next_line};
pub use lock::Lock;
pub use name::{MAX_NAME_BYTES, NAME_RULE, is_letter, is_name};
pub use notices::notice;
pub use plain_words::{describe_json_error, describe_toml_error, in_plain_words, without_error_numbers};
pub use player::{Player, PlayerNameError};
pub use reading::{
    MAX_LARGE_FILE, MAX_PRACTICE_FILE, MAX_SMALL_FILE, open, open_stream, read, read_if_exists, read_text,
    rename_unreadable,
};
