//! How long a build takes, in words.

use crate::diag::Diagnostic;

/// A build of so many seconds, mostly for the model `name`; with the largest `detail` that makes it short, and its seconds.
pub fn slow(seconds: f64, name: &str, vertices: usize, detail: Option<(usize, f64)>) -> Diagnostic {
    let told = Diagnostic::note(format!(
        "this build will take about {}; the largest model, \"{name}\", has {vertices} vertices",
        duration(seconds)
    ));
    match detail {
        Some((most, shorter)) => told.help(format!(
            "`--set detail={most}` simplifies the models: about {}",
            duration(shorter)
        )),
        None => told.help("`--quality draft` is for quick looks"),
    }
}

/// Rounded as an estimate is.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 95.0 => format!("{:.0} s", (s / 10.0).ceil() * 10.0),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.0} hours", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn estimates_are_round() {
        let told = [4.0, 61.0, 94.0, 95.0, 700.0, 9000.0].map(duration);
        assert_eq!(
            told,
            [
                "10 s",
                "70 s",
                "100 s",
                "2 minutes",
                "12 minutes",
                "2 hours"
            ]
        );
    }
}
