//! `qhat bench`: the table, the file, and input that is refused.

use crate::common::Folder;

#[test]
fn a_workload_is_measured_under_one_setting() {
    let folder = Folder::new();
    let arguments = ["bench", "chain10", "four-bar", "--setting", "dop853:1e-4", "--csv", "numbers.csv"];
    let table = folder.qhat(&arguments).well().stdout;
    let csv = folder.read("numbers.csv");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((table.lines().count(), lines.len()), (3, 3), "{table}\n{csv}");
    let columns: Vec<&str> = lines[0].split(',').collect();
    for (line, name) in lines[1..].iter().zip(["chain10", "four-bar"]) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), columns.len(), "{line}");
        let cell = |name: &str| cells[columns.iter().position(|&column| column == name).unwrap()];
        let number = |name: &str| cell(name).parse::<f64>().unwrap();
        assert_eq!((cell("workload"), cell("integrator"), cell("ended")), (name, "dop853", "\"\""));
        assert_eq!(number("simulated_s"), 2.0);
        // The documented error of every rod, and the energy error that a tolerance of 1e-4 allows.
        assert!(number("worst_length_error") <= 1e-10 && number("energy_error").abs() <= 1e-2, "{line}");
        assert!(number("cpu_ms_per_simulated_s") > 0.0, "{line}");
        // Both are open chains (a four-bar linkage ends at its two nails): in lanes no A is factored.
        assert_eq!(number("factorizations"), 0.0, "{line}");
    }
}

#[test]
fn a_run_that_costs_too_much_says_how_far_it_got() {
    let table = Folder::new().qhat(&["bench", "chain10", "--setting", "rattle:1e-4", "--limit", "0"]).well().stdout;
    assert!(table.contains("t = 0.0167 s: too slow"), "{table}");
}

#[test]
fn what_cannot_be_run_is_refused_before_anything_is() {
    let folder = Folder::with(&[("kept.csv", "mine")]);
    for (arguments, message) in [
        (&["bench", "chain10", "rope5"][..], "no workload `rope5`"),
        (&["bench", "chain10", "--setting", "dop853"], "`dop853` is no setting"),
        (&["bench", "chain10", "--limit", "-1"], "--limit must be"),
        (&["bench", "chain10", "--csv", "kept.csv"], "kept.csv"),
    ] {
        let ran = folder.qhat(arguments).refused(message);
        assert_eq!(ran.stdout, "", "{arguments:?}");
    }
    assert_eq!(folder.read("kept.csv"), "mine");
}
