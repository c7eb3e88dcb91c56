//! The one place where lights and cameras of hosts are checked.

use crate::{error::Error, view::View};
use umbrage_core::glam::DMat3;
use umbrage_core::{CameraView, Light, LightShape};

/// A view whose numbers are finite, and whose light has directions of unit length.
pub(crate) struct Checked<'a> {
    view: View<'a>,
    /// Takes the place of the view's light.
    light: Option<Light>,
}

impl<'a> Checked<'a> {
    pub fn new(view: &View<'a>) -> Result<Self, Error> {
        check_camera(&view.camera)?;
        let light = view.light.usable().map_err(Error::Light)?;
        if let LightShape::Rect { texture: Some(texture), .. } = view.light.shape
            && texture >= view.textures.len()
        {
            let count = view.textures.len();
            return Err(Error::Light(format!(
                "the rect light shows texture {texture} of {count} in the view, counted from 0; hand over the scene's \
                 textures"
            )));
        }
        Ok(Self { view: *view, light })
    }

    pub fn view(&self) -> View<'_> {
        View { light: self.light.as_ref().unwrap_or(self.view.light), ..self.view }
    }
}

fn check_camera(camera: &CameraView) -> Result<(), Error> {
    let CameraView { eye, view_from_world, clip_from_view } = camera;
    if !(eye.is_finite() && view_from_world.is_finite()) {
        let what = format!("the camera at {eye} has a view transform that is not finite; give it a finite one");
        return Err(Error::Camera(what));
    }
    if !(clip_from_view.is_finite() && clip_from_view.inverse().is_finite()) {
        let what = format!(
            "the camera's projection {clip_from_view} has no inverse; give it a picture with an area, and a near plane \
             over 0"
        );
        return Err(Error::Camera(what));
    }
    let turned = view_from_world.matrix3;
    if (turned.transpose() * turned - DMat3::IDENTITY).to_cols_array().iter().any(|x| x.abs() > 1e-3) {
        let what = format!(
            "the camera's view transform {turned} scales or shears; make it a rotation and a translation, and let the \
             projection do the rest"
        );
        return Err(Error::Camera(what));
    }
    Ok(())
}
