//! A finished sweep, and the files that it makes.

use crate::{
    error::Error,
    html,
    output::Folder,
    pictures::Pictures,
    sweep::{along, plot, record::SweepReport, table},
};

/// A finished sweep.
#[derive(Clone, Debug)]
pub struct SweepOutcome {
    /// The numbers.
    pub report: SweepReport,
    /// The pictures of the references.
    pub pictures: Pictures,
    /// Techniques and parameters that plots of the error run along.
    pub(crate) along: Vec<(String, String)>,
}

impl SweepOutcome {
    /// Writes `sweep.json`, `index.html`, the pictures of the references and the plots.
    ///
    /// # Errors
    /// A folder that can't be written to.
    pub fn write(&self, folder: &Folder) -> Result<(), Error> {
        let (pictures, earlier_plots) = (folder.pictures_of("sweep.json"), folder.plots_of("sweep.json"));
        for (name, bytes) in &self.pictures.files {
            folder.write(name, bytes)?;
        }
        folder.remove(pictures, |name| self.pictures.files.contains_key(name));
        let mut plots = plot::all(&self.report);
        plots.extend(along::all(&self.report, &self.along));
        for plot in &plots {
            folder.write(&plot.file, plot.svg.as_bytes())?;
        }
        folder.remove(earlier_plots, |name| plots.iter().any(|plot| plot.file == name));
        folder.write("sweep.json", self.json().as_bytes())?;
        folder.write("index.html", html::sweep_page(&self.report, &self.pictures.files, &plots).as_bytes())
    }

    /// The text of `sweep.json`.
    pub fn json(&self) -> String {
        crate::json(&self.report)
    }

    /// For each light, both answers by the mean absolute error.
    pub fn tables(&self) -> String {
        table::tables(&self.report)
    }
}
