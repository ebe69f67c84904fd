//! With the feature `page`: says what is missing when the page was not built, and notices when it was built anew.

use std::path::Path;

fn main() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var_os("CARGO_FEATURE_PAGE").is_none() {
        return Ok(());
    }
    let page = Path::new("../../playground/dist");
    println!("cargo::rerun-if-changed={}", page.display());
    // Files are named after their content, so a new build brings new names, which only a look into the folders shows.
    println!("cargo::rerun-if-changed={}", page.join("assets").display());
    if page.join("index.html").is_file() {
        return Ok(());
    }
    Err("the feature `page` needs the built page in playground/dist: run `make page` first".into())
}
