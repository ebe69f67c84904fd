//! The `qhat` command: reads scenes, runs the engine, writes the results. It computes no physics of its own.
//!
//! Exit codes: 0 done, 1 the motion diverged or the constraints cannot hold (the frames reached are written, and the
//! output is marked), 2 bad input, 130 interrupted.

mod arguments;
mod bench;
mod check;
mod failure;
mod output;
mod play;
mod print;
mod render;
mod run;
mod scenes;
mod source;
mod status;
mod trajectory;

use arguments::{Arguments, Command};
use clap::{CommandFactory, Parser};
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Render(arguments) => render::render(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Play(arguments) => play::play(&arguments),
        Command::Scenes(arguments) => scenes::scenes(&arguments),
        Command::Bench(arguments) => bench::bench(&arguments),
        Command::Schema => print::json(&qhat_scene::json_schema()).map(|()| ExitCode::SUCCESS),
        Command::Completions { shell } => completions(shell),
    };
    outcome.unwrap_or_else(|failure| failure.report())
}

fn completions(shell: clap_complete::Shell) -> Result<ExitCode, Failure> {
    // The script goes into memory first, because the generator would panic on a closed pipe.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "qhat", &mut script);
    print::bytes(&script)?;
    Ok(ExitCode::SUCCESS)
}
