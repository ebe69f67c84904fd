//! The examples say what they should.

use std::error::Error;

macro_rules! examples {
    ($($name:ident: $path:literal,)*) => {$(
        #[path = $path]
        #[allow(dead_code, reason = "the test calls what main calls")]
        mod $name;
    )*};
}

examples! {
    pendulum: "../examples/pendulum.rs",
    bridge: "../examples/bridge.rs",
    slider_crank: "../examples/slider_crank.rs",
    slack_rope: "../examples/slack_rope.rs",
    expression: "../examples/expression.rs",
    sweep: "../examples/sweep.rs",
    game: "../examples/game.rs",
    picture: "../examples/picture.rs",
}

fn said(tell: impl FnOnce(&mut Vec<u8>) -> Result<(), Box<dyn Error>>) -> String {
    let mut out = Vec::new();
    tell(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// The numbers of a line.
#[expect(dead_code, reason = "used by the checks below")]
fn numbers(line: &str) -> Vec<f64> {
    line.split([' ', '(', ')', ',']).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn show() {
    for text in [
        said(|out| pendulum::tell(out)),
        said(|out| bridge::tell(out)),
        said(|out| slider_crank::tell(out)),
        said(|out| slack_rope::tell(out)),
        said(|out| expression::tell(out)),
        said(|out| sweep::tell(out)),
        said(|out| game::tell(out)),
        said(|out| picture::tell(out)),
    ] {
        println!("{text}");
    }
}
