//! Suggestions for mistyped names.

use strsim::jaro_winkler;

/// Minimum similarity, from 0 to 1, of a typed text to a name for a suggestion.
const MIN_SIMILARITY: f64 = 0.8;

/// Returns the end of a sentence about an unknown name `text`: which of `names` was probably meant, or nothing if none is similar.
pub fn did_you_mean<S: AsRef<str>>(text: &str, names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<S> = names.into_iter().collect();
    let nearest = most_similar(text, names.iter().map(|name| [name.as_ref(); 2]));
    nearest.map(|name| format!("; did you mean \"{name}\"?")).unwrap_or_default()
}

/// Returns the name whose spelling is most similar to `text`, ignoring case, if one is similar enough. `names` are pairs of a spelling and
/// the name that it stands for.
pub fn most_similar<'a>(text: &str, names: impl IntoIterator<Item = [&'a str; 2]>) -> Option<&'a str> {
    let wanted = text.to_lowercase();
    let rated = names.into_iter().map(|[spelling, name]| (jaro_winkler(&spelling.to_lowercase(), &wanted), name));
    let (similarity, nearest) = rated.max_by(|one, other| one.0.total_cmp(&other.0))?;
    (similarity > MIN_SIMILARITY).then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_similar_names_are_suggested() {
        let names = ["match", "textbook", "thesis"];
        assert_eq!(did_you_mean("mtch", names), "; did you mean \"match\"?");
        assert_eq!(did_you_mean("Text-book", names), "; did you mean \"textbook\"?");
        assert_eq!(["xyzzy", ""].map(|text| did_you_mean(text, names)), ["", ""]);
        assert_eq!(did_you_mean("match", [""; 0]), "");
    }
}
