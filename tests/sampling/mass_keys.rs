//! Keys of parts exist where a change of them changes the mass properties of the spacecraft.

use spindrift::scene::{MassErrors, Name, Parameter, PartInput, PartShape, Scene, SceneInput};

/// Law: a parameter of a part, alone or one of two, exists where a change of it changes mass, centre or inertia, whatever keys of the body replace.
#[test]
fn parts_exist_where_they_change_the_mass_properties() {
    const TURNED: [f64; 4] = [0.8, 0.0, 0.6, 0.0];
    let mut seen = [0; 2];
    for kind in 0..64 {
        let is = |bit: u32| kind >> bit & 1 == 1;
        let mut scene = SceneInput::report();
        let part = |name: &str, position_m: [f64; 3]| PartInput {
            name: Name::of(name),
            shape: PartShape::Box,
            size_m: Some([1.0, 2.0, 3.0]),
            density_kg_m3: (!is(3)).then_some(100.0),
            mass_kg: is(3).then_some(600.0),
            position_m,
            errors: MassErrors { center_offset_m: [if is(4) { 0.1 } else { 0.0 }, 0.0, 0.0], ..MassErrors::DEFAULT },
            ..PartInput::DEFAULT
        };
        scene.parts = vec![part("b", [0.0, 0.5, 2.0])];
        if is(5) {
            scene.parts.push(part("a", [0.0; 3]));
        }
        scene.body.mass_kg = is(0).then_some(1300.0);
        scene.body.center_of_mass_m = is(1).then_some([0.0, 0.1, 1.0]);
        scene.body.inertia_kg_m2 = is(2).then_some([[3e3, 0.0, 1e2], [0.0, 3e3, 2e2], [1e2, 2e2, 2e3]]);
        let properties = |scene: &SceneInput| {
            let mass = Scene::resolve(scene).expect("physical").mass;
            [vec![mass.total], mass.center.to_vec(), mass.inertia.as_flattened().to_vec()].concat()
        };
        let nominal = properties(&scene);
        for parameter in Parameter::all(&scene).filter(|p| p.name().starts_with("body.parts.b.")) {
            if parameter.value(&scene, 0).is_none() {
                continue;
            }
            let mut changed = scene.clone();
            let is_attitude = parameter.width() == TURNED.len();
            for (component, turned) in TURNED.iter().enumerate().take(parameter.width()) {
                let value = parameter.value(&scene, component).expect("it has the key");
                let other = if is_attitude { *turned } else { 1.1 * value + 0.01 };
                parameter.set(&mut changed, component, other);
            }
            let off = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9 * (1.0 + b.abs());
            let is_changed = properties(&changed).iter().zip(&nominal).any(off);
            assert_eq!(parameter.exists(&scene, 0), is_changed, "{} of kind {kind:b}", parameter.name());
            seen[usize::from(is_changed)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 40), "{seen:?}");
}
