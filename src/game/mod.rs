//! What counts: rules, difficulty and the thesis' rewards.
