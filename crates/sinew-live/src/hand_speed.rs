//! The largest speed of tools that a user steers.

use sinew_fem::Model;
use sinew_mesh::vector::{length, sub};

/// Share of the speed of waves in the softest part of a body: a tool that hits tissue at this speed strains it by about
/// as much at once, before the tissue behind can move.
const SHARE: f64 = 0.1;

/// The largest speed (m/s) of steered tools unless the user names another one: a share of the distance that an edge of a
/// tetrahedron is long over its stable step, the least of all tetrahedra.
pub(crate) fn hand_speed(model: &Model) -> f64 {
    let mesh = model.mesh();
    let tets = mesh.tets.iter().enumerate().map(|(tet, nodes)| {
        let vertices = nodes.map(|node| mesh.points[node as usize]);
        let edges = (0..4).flat_map(|i| (0..i).map(move |j| [i, j]));
        let shortest = edges
            .map(|[i, j]| length(sub(vertices[i], vertices[j])))
            .fold(f64::INFINITY, f64::min);
        // The stable step is 2 over the frequency.
        0.5 * shortest * model.tet_frequency(tet, &vertices)
    });
    let speed = SHARE * tets.fold(f64::INFINITY, f64::min);
    // Two digits are what a page can show.
    let digits = 10f64.powf(speed.log10().floor() - 1.0);
    (speed / digits).round() * digits
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource};

    use super::*;

    /// A cube of Young's modulus 3500 Pa times `stiffer`.
    fn speed(stiffer: f64, edge: f64) -> f64 {
        let text = format!(
            "[mesh]\ncube = {{ cells = 3, edge = {edge:?} }}\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
             youngs_modulus = {:?}\npoissons_ratio = 0.45\n[[fixed]]\ngroup = \"bottom\"\n\
             [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n",
            3500.0 * stiffer
        );
        let scene = Scene::parse(SceneSource::new("cube.toml", text)).unwrap();
        let simulation = scene.build().unwrap();
        hand_speed(&simulation.model().body().unwrap().model)
    }

    #[test]
    fn it_is_a_tenth_of_the_speed_of_waves_whatever_the_mesh() {
        // Of compression: sqrt((1 - nu) E / ((1 + nu) (1 - 2 nu) rho)).
        let waves = (0.55 * 3500.0 / (1.45 * 0.1 * 1060.0_f64)).sqrt();
        for edge in [0.01, 0.1, 1.0] {
            let ratio = speed(1.0, edge) / waves;
            assert!((0.05..0.4).contains(&ratio), "{edge} m: {ratio}");
        }
        let ratio = speed(4.0, 0.1) / speed(1.0, 0.1);
        assert!((ratio - 2.0).abs() < 0.1, "{ratio}");
    }
}
