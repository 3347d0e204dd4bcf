//! The terminal program: screens, input and drawing.
