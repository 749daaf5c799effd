//! A room that a small lamp lights.

use std::sync::Arc;

use cohort::scene::{LoadOptions, Scene};

/// From where a room is seen.
pub struct View {
    /// Pixels on each side.
    pub side: u32,
    /// In degrees.
    pub field_of_view: u32,
    /// In the room.
    pub origin: &'static str,
    /// What is in the middle of the image.
    pub target: &'static str,
}

/// A closed room of reflectance 0.6, from -1 to 1 on every axis, with a square lamp of 0.2 by 0.2, black, with radiance 100. `lamp` are the transforms that turn
/// it from facing z to where it faces, and put it there; `contents` are other shapes.
pub fn room(view: &View, lamp: &str, contents: &str) -> Arc<Scene> {
    let View {
        side,
        field_of_view,
        origin,
        target,
    } = view;
    let xml = format!(
        r#"<scene version="3.0.0">
    <integrator type="path"/>
    <sensor type="perspective">
        <float name="fov" value="{field_of_view}"/>
        <transform name="to_world"><lookat origin="{origin}" target="{target}" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="{side}"/><integer name="height" value="{side}"/><rfilter type="box"/></film>
    </sensor>
    <shape type="cube">
        <boolean name="flip_normals" value="true"/>
        <bsdf type="diffuse"><float name="reflectance" value="0.6"/></bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="0.1"/>{lamp}</transform>
        <bsdf type="diffuse"><float name="reflectance" value="0"/></bsdf>
        <emitter type="area"><float name="radiance" value="100"/></emitter>
    </shape>
    {contents}
</scene>"#
    );
    let scene = Scene::from_xml(&xml, &LoadOptions::default());
    Arc::new(scene.expect("the scene can be loaded"))
}
