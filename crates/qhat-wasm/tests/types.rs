//! The declarations for TypeScript agree with the types in Rust.

const TYPES: &str = include_str!("../src/types.d.ts");

/// The fields of an interface, in order.
fn fields(interface: &str) -> Vec<&'static str> {
    let start = TYPES.find(&format!("export interface {interface} {{")).expect("the interface is declared");
    let body = &TYPES[start..start + TYPES[start..].find("\n}").expect("the interface ends")];
    let lines = body.lines().skip(1).map(str::trim).filter(|line| !line.starts_with("/**"));
    lines.filter_map(|line| line.split_once(':')).map(|(name, _)| name).collect()
}

#[test]
fn terms_have_the_fields_of_the_notation_table_in_its_order() {
    let mut words: Vec<&str> = qhat::NOTATION.iter().map(|row| row.word).collect();
    words.push("warnings"); // text, so the table of symbols does not have it
    assert_eq!(fields("Terms"), words);
}

#[test]
fn every_integrator_is_named() {
    for integrator in qhat::Integrator::ALL {
        assert!(TYPES.contains(&format!("'{integrator}'")), "{integrator}");
    }
}

/// Every kind of shape is declared, and every declared kind exists.
#[test]
fn every_kind_of_shape_is_named() {
    let declared: Vec<&str> = TYPES[TYPES.find("export type ShapeKind").unwrap()..]
        .lines()
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.trim().strip_prefix("| '")?.split('\'').next())
        .collect();
    let made: Vec<&str> = qhat_shapes::ShapeKind::ALL.iter().map(|kind| kind.name()).collect();
    assert_eq!(declared, made);
}

#[test]
fn every_solver_is_named() {
    for solver in [qhat::Solver::Rows, qhat::Solver::Chains, qhat::Solver::EndOfStep] {
        assert!(TYPES.contains(&format!("'{solver}'")), "{solver}");
    }
}

/// The page adds one field, the reason of auto's choice, and has every other field by its Rust name.
#[test]
fn a_report_has_the_fields_of_the_engine() {
    let report = format!("{:#?}", qhat::StepReport::default());
    let known: Vec<&str> =
        report.lines().filter_map(|line| line.strip_prefix("    ")?.split_once(':')).map(|(name, _)| name).collect();
    let known: Vec<&str> = known.into_iter().filter(|name| !name.starts_with(' ')).collect();
    let told: Vec<&str> = fields("StepReport").into_iter().filter(|name| *name != "too_stiff").collect();
    assert_eq!(told, known);
}
