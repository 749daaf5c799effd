use glam::DMat4;

use super::*;

/// `steps` gives the matrix with these rows.
#[track_caller]
fn check(steps: &str, rows: [[f64; 4]; 3]) {
    let shape = object(&format!(
        r#"<shape type="sphere"><transform name="to_world">{steps}</transform></shape>"#
    ));
    let matrix = shape.transform("to_world").unwrap().unwrap();
    let [x, y, z] = rows;
    let flat: Vec<f64> = [x, y, z, [0.0, 0.0, 0.0, 1.0]].concat();
    let expected = DMat4::from_cols_slice(&flat).transpose();
    assert!(
        matrix.abs_diff_eq(expected, 1e-14),
        "{steps}: {matrix} instead of {expected}"
    );
}

#[test]
fn steps_multiply_from_the_left() {
    check(
        r#"<translate x="1"/><scale value="2"/>"#,
        [
            [2.0, 0.0, 0.0, 2.0],
            [0.0, 2.0, 0.0, 0.0],
            [0.0, 0.0, 2.0, 0.0],
        ],
    );
    check(
        r#"<scale y="3"/><translate value="1, 2 3"/>"#,
        [
            [1.0, 0.0, 0.0, 1.0],
            [0.0, 3.0, 0.0, 2.0],
            [0.0, 0.0, 1.0, 3.0],
        ],
    );
}

#[test]
fn rotations_are_mitsubas_also_about_axes_that_are_not_unit_vectors() {
    check(
        r#"<rotate z="1" angle="90"/>"#,
        [
            [0.0, -1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ],
    );
    check(
        r#"<rotate value="1 2 3" angle="40"/>"#,
        [
            [1.0, -1.460451715297574, 1.9874418900161441, 0.0],
            [
                2.3962739428216615,
                1.7018666706430656,
                0.760945731599592,
                0.0,
            ],
            [
                -0.5837085487300129,
                2.0465209509726705,
                2.871644455048175,
                0.0,
            ],
        ],
    );
}

#[test]
fn cameras_look_as_in_mitsuba() {
    check(
        r#"<lookat origin="1,2,3" target="4 6 5" up="0,3,0.5"/>"#,
        [
            [
                0.4015084905827965,
                -0.7269429856623678,
                0.5570860145311556,
                1.0,
            ],
            [
                0.15056568396854866,
                0.6523847307226377,
                0.7427813527082074,
                2.0,
            ],
            [
                -0.903394103811292,
                -0.21435498295172387,
                0.3713906763541037,
                3.0,
            ],
        ],
    );
    // Without an up vector Mitsuba chooses one.
    check(
        r#"<lookat origin="1,2,3" target="4 6 5"/>"#,
        [
            [
                0.3017324753500302,
                0.7737006434874774,
                0.5570860145311556,
                1.0,
            ],
            [
                -0.5976900328666264,
                -0.3017324753500302,
                0.7427813527082074,
                2.0,
            ],
            [
                0.7427813527082074,
                -0.5570860145311556,
                0.3713906763541037,
                3.0,
            ],
        ],
    );
    check(
        r#"<lookat origin="1,2,3" target="-4 -6 -5"/>"#,
        [
            [
                -0.15875880145458224,
                0.9007757490908862,
                -0.40422604172722165,
                1.0,
            ],
            [
                0.7459859176726684,
                -0.15875880145458218,
                -0.6467616667635546,
                2.0,
            ],
            [
                -0.6467616667635546,
                -0.40422604172722165,
                -0.6467616667635546,
                3.0,
            ],
        ],
    );
}

#[test]
fn matrices_are_written_row_by_row() {
    check(
        r#"<matrix value="1 2 3 4 5 6 7 8 9"/>"#,
        [
            [1.0, 2.0, 3.0, 0.0],
            [4.0, 5.0, 6.0, 0.0],
            [7.0, 8.0, 9.0, 0.0],
        ],
    );
    check(
        r#"<matrix value="1 2 3 4, 5 6 7 8, 9 10 11 12, 0 0 0 1"/>"#,
        [
            [1.0, 2.0, 3.0, 4.0],
            [5.0, 6.0, 7.0, 8.0],
            [9.0, 10.0, 11.0, 12.0],
        ],
    );
}
