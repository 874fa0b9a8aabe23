//! The shared struct and where maps are.

mod common;

use common::{CASES, EPS, Worst, rng};
use dpsm::scalar::float::{Vec2, Vec4};
use dpsm::scalar::light::*;

#[test]
fn layers_hold_one_hemisphere_each_and_an_atlas_holds_both() {
    let layers = dpsm::cases::light(DPSM_LAYERS);
    assert_eq!([0, 1].map(|h| dpsm_light_layer(layers, h)), [6, 7]);
    let atlas = dpsm::cases::light(DPSM_ATLAS);
    assert_eq!([0, 1].map(|h| dpsm_light_layer(atlas, h)), [6, 6]);
}

#[test]
fn coordinates_in_layers_are_the_maps_own() {
    let light = dpsm::cases::light(DPSM_LAYERS);
    let st = Vec2::new(0.3_f32, 0.9);
    assert_eq!(dpsm_light_coordinates(light, 1, st), st);
}

#[test]
fn back_map_begins_in_an_atlas_where_the_front_map_ends() {
    let light = dpsm::cases::light(DPSM_ATLAS);
    let at = |hemisphere, s, t| dpsm_light_coordinates(light, hemisphere, Vec2::new(s, t));
    assert_eq!(at(0, 0.0, 0.0), Vec2::new(0.25, 0.5));
    assert_eq!(at(0, 1.0, 1.0), Vec2::new(0.5, 1.0));
    assert_eq!(at(1, 0.0, 0.0), Vec2::new(0.5, 0.5));
    assert_eq!(at(1, 1.0, 1.0), Vec2::new(0.75, 1.0));
}

#[test]
fn atlas_coordinates_stay_within_their_bound() {
    let mut rng = rng("atlas");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let width = rng.f32() * 0.5;
        let height = rng.f32();
        let place = [rng.f32() * (1.0 - 2.0 * width), rng.f32() * (1.0 - height)];
        let light = DpsmLight {
            rectangle: Vec4::new(place[0], place[1], width, height),
            ..dpsm::cases::light(DPSM_ATLAS)
        };
        let (hemisphere, st) = (rng.u32(0..2), Vec2::new(rng.f32(), rng.f32()));
        let at = dpsm_light_coordinates(light, hemisphere, st);
        let exact = dpsm_light_coordinates(light.widen(), hemisphere, st.widen());
        worst.note((at.widen() - exact).length(), 3.0 * EPS, (place, st));
    }
    worst.check("dpsm_light_coordinates, both components together");
}

#[cfg(feature = "naga")]
#[test]
fn layout_is_the_same_in_rust_and_in_the_shader() {
    use std::mem::offset_of;
    let linked = dpsm::link(&["light"]).unwrap();
    let module = dpsm::validate(&linked).unwrap().module;
    let ty = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("DpsmLight")).unwrap().1;
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("DpsmLight is {:?}", ty.inner)
    };
    let shader: Vec<_> = members
        .iter()
        .map(|member| {
            let size = module.types[member.ty].inner.size(module.to_ctx());
            (member.name.clone().unwrap(), member.offset as usize, size as usize)
        })
        .collect();
    macro_rules! rust {
        ($($member:ident: $t:ty),+ $(,)?) => {
            vec![$((
                stringify!($member).to_string(),
                offset_of!(DpsmLight<f32>, $member),
                size_of::<$t>(),
            )),+]
        };
    }
    let rust = rust![
        position: [f32; 3], near: f32, right: [f32; 3], far: f32, up: [f32; 3], guard: f32,
        forward: [f32; 3], size: f32, rectangle: [f32; 4], first_layer: u32, placement: u32,
        hemispheres: u32, reversed: u32,
    ];
    assert_eq!(shader, rust);
    assert_eq!(*span as usize, size_of::<DpsmLight<f32>>());
}

#[cfg(feature = "gpu")]
#[test]
fn bytes_of_the_struct_are_its_words_in_order() {
    use dpsm::scalar::ports::{Flat, Word};
    let light = dpsm::cases::light(DPSM_ATLAS);
    let mut words = Vec::new();
    light.write(&mut words);
    let bits = words.into_iter().map(|word| match word {
        Word::Float(value) => value.to_bits(),
        Word::Integer(value) => value,
    });
    let bytes: &[u32] = bytemuck::cast_slice(bytemuck::bytes_of(&light));
    assert_eq!(bits.collect::<Vec<_>>(), bytes);
}
