//! Every recipe of docs/recipes.md, inserted into the scene at the head of that document, is read and moves.

use qhat_scene::{Format, load};

#[test]
fn every_recipe_moves() {
    let guide = include_str!("../../../docs/recipes.md");
    let blocks = guide.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default());
    let blocks: Vec<&str> = blocks.collect();
    let (head, recipes) = blocks.split_first().expect("a scene at the head");
    assert!(recipes.len() >= 10, "{} recipes", recipes.len());
    for recipe in recipes {
        let scene = load(&format!("{head}\n{recipe}"), "recipe.toml", Format::Toml);
        let scene = scene.unwrap_or_else(|errors| panic!("{recipe}\n{errors}"));
        let mut simulation = scene.simulation().unwrap_or_else(|error| panic!("{recipe}\n{error}"));
        for _ in 0..10 {
            simulation.step().unwrap_or_else(|error| panic!("{recipe}\n{error}"));
        }
    }
}
