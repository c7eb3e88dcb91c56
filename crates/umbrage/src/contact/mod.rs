//! Contact shadows: what any technique that answers with visibility leaves lit between a caster and
//! its shadow, because of its bias or the size of its texels, is found in the depth buffer.

mod march;

use crate::shader::Shader;
use crate::technique::{InOrder, Inside, Stats, Technique, inside_of};
use crate::{Answer, Error, Gpu, Passes, Settings, View, VisibilityTarget};
use march::March;

/// The shader, for the registry's tests.
pub(crate) const SHADERS: [&Shader; 1] = [&march::SHADER];

/// A length in space or on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Metres.
    Metres(f64),
    /// Pixels: as many metres as these span at the place of the surface, across the view.
    Pixels(f64),
}

impl Length {
    /// The number, and whether it is one of pixels.
    fn parts(self) -> (f64, bool) {
        match self {
            Self::Metres(length) => (length, false),
            Self::Pixels(length) => (length, true),
        }
    }

    fn check(self, name: &str) -> Result<(), Error> {
        let (length, _) = self.parts();
        if length.is_finite() && length > 0.0 && length <= MOST {
            return Ok(());
        }
        let expected = format!("a length over 0 and up to {MOST}, in metres such as 0.1, or in pixels such as 16px");
        Err(Error::Setting { technique: NAME.into(), name: name.into(), value: self.to_string(), expected })
    }
}

/// Metres without a unit, `px` after pixels.
impl std::fmt::Display for Length {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Metres(length) => write!(f, "{length}"),
            Self::Pixels(length) => write!(f, "{length}px"),
        }
    }
}

impl std::str::FromStr for Length {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.strip_suffix("px") {
            Some(number) => number.parse().map(Self::Pixels),
            None => text.parse().map(Self::Metres),
        }
    }
}

/// The longest length that is taken.
const MOST: f64 = 1e6;

/// What messages call it.
const NAME: &str = "contact shadows";

/// How far contact shadows are looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// How long the rays from surfaces to the light are. What a technique leaves lit at most is
    /// enough: more only adds what the picture does not show rightly.
    pub length: Length,
    /// How far behind what is seen there still is something of it. Thinner things cast too much
    /// where the camera looks past them; of thicker ones shadows on the far side have a gap.
    pub thickness: Length,
}

impl Contact {
    /// That rays can be so long and things so thick.
    ///
    /// # Errors
    /// [`Error::Setting`] for a length that is not over 0, or not finite.
    pub fn check(&self) -> Result<(), Error> {
        self.length.check("contact")?;
        self.thickness.check("contact-thickness")
    }

    /// Rays of this length, and things half as thick.
    pub fn new(length: Length) -> Self {
        let thickness = match length {
            Length::Metres(length) => Length::Metres(0.5 * length),
            Length::Pixels(length) => Length::Pixels(0.5 * length),
        };
        Self { length, thickness }
    }
}

/// Adds contact shadows to `inner`: a surface counts as shadowed, too, where a short ray from it to
/// the light meets what the depth buffer shows, with 16 look-ups; of a soft light four rays to
/// points of it with 8 each, and the smaller visibility counts. What a shadow lacks near contact is
/// then at most what a step of the ray leaves over, a 16th (an 8th) of its length.
///
/// Its own errors: it finds only what is on the picture and hidden by nothing nearer, and nothing
/// thinner than a step; it takes all that is seen for as thick as [`Contact::thickness`]; and the
/// four rays to a soft light make steps of a quarter.
///
/// # Errors
/// [`Error::Setting`] for lengths that are not over 0 or not finite, [`Error::Unsupported`] for a
/// technique that answers with radiance.
pub fn contact_shadows(gpu: &Gpu, inner: Box<dyn Technique>, contact: Contact) -> Result<Box<dyn Technique>, Error> {
    contact.check()?;
    if inner.answer() != Answer::Visibility {
        let what = format!("techniques that answer with {}; leave `contact` out", inner.answer().name());
        return Err(Error::Unsupported { technique: NAME.into(), what });
    }
    Ok(Box::new(WithContact { inner, march: March::new(gpu, contact) }))
}

/// A technique with rays after it.
struct WithContact {
    inner: Box<dyn Technique>,
    march: March,
}

/// Shaders of hosts look maps up and march nothing, so it lends nothing.
impl Technique for WithContact {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.inner.prepare_view(gpu, view, order)?;
        self.march.prepare(gpu, view);
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        order: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.inner.record_visibility(passes, view, visibility, order)?;
        self.march.record(passes, view, visibility);
        Ok(())
    }

    fn set_frame(&mut self, frame: u32) {
        self.inner.set_frame(frame);
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.inner.set(gpu, settings)
    }

    fn draws_host_casters(&self) -> bool {
        self.inner.draws_host_casters()
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

/// All but the rays is the inner technique's.
impl Inside for WithContact {
    inside_of!(inner);

    fn stats(&self) -> Stats {
        let stats = self.inner.inside().stats();
        let bytes = stats.bytes + self.march.bytes();
        Stats { draws: stats.draws + 1, triangles: stats.triangles + 1, bytes, ..stats }
    }

    fn forget(&mut self) {
        self.inner.inside_mut().forget();
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        if pass == march::PASS { Some(self.march.reads()) } else { self.inner.inside().reads(pass) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_a_technique_is_inside_the_one_with_contact_shadows() {
        let contact = Contact::new(Length::Metres(0.1));
        assert_forwards(|gpu, inner| contact_shadows(gpu, inner, contact).expect("lengths over 0"));
    }

    #[test]
    fn lengths_are_read_as_they_are_written() {
        for text in ["0.25", "16px"] {
            assert_eq!(text.parse::<Length>().map(|length| length.to_string()).as_deref(), Ok(text));
        }
        assert!("px".parse::<Length>().is_err());
        for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.0 * MOST] {
            let error = Length::Metres(length).check("contact").expect_err("out of its range");
            assert!(error.to_string().contains("16px"), "{error}");
        }
    }
}
