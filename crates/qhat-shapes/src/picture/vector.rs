//! Vectors of three numbers.

pub(super) type Vec3 = [f64; 3];

pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn plus(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|k| a[k] + b[k])
}

pub(super) fn minus(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|k| a[k] - b[k])
}

pub(super) fn scaled(a: Vec3, factor: f64) -> Vec3 {
    a.map(|x| x * factor)
}

pub(super) fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn unit(a: Vec3) -> Vec3 {
    scaled(a, 1.0 / norm(a))
}

/// The unit vector of a direction, and two unit vectors at right angles to it and to each other.
pub(super) fn frame(direction: Vec3) -> [Vec3; 3] {
    let n = unit(direction);
    let least = (0..3).min_by(|&i, &k| n[i].abs().total_cmp(&n[k].abs())).unwrap_or(0);
    let axis = std::array::from_fn(|k| if k == least { 1.0 } else { 0.0 });
    let u = unit(cross(axis, n));
    [n, u, cross(n, u)]
}
