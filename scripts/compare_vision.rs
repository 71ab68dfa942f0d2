// What scripts/compare-vision builds with the crate colorvideovdp: the quality of a picture beside its reference.
//     jod PIXELS_PER_DEGREE WIDTH HEIGHT REFERENCE TEST MAP
// REFERENCE and TEST hold 32-bit RGB in cd/m^2, rows from the top; MAP gets the distortion by pixel. Prints JOD.
// SPDX-License-Identifier: MIT
use colorvideovdp::{Color, Cvvdp, DisplayModel, Geometry, Image, Options, Photometry};
use std::{env, error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [density, width, height, reference, test, map] = words.as_slice() else {
        return Err("six arguments are expected".into());
    };
    let (width, height): (usize, usize) = (width.parse()?, height.parse()?);
    let picture = |file: &String| -> Result<Image, Box<dyn Error>> {
        let values = fs::read(file)?.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect();
        Ok(Image::new(width, height, 3, values)?)
    };
    // A display that shows luminances as they are, up to 1e5 cd/m^2; the metric itself has a floor of 0.005 cd/m^2.
    let light = Photometry::new(1e5, 1e9, 0.0, 0.0, 1.0)?;
    let geometry = Geometry::from_ppd([width, height], density.parse()?)?;
    let display = DisplayModel::new("scene", light, geometry, "BT.709-linear")?;
    let metric = Cvvdp::new(display, Options::default().with_distortion_map(true))?;
    let found = metric.predict_image(&picture(test)?, &picture(reference)?, Color::Linear)?;
    let values = found.distortion_map.ok_or("no map")?.data;
    fs::write(map, values.iter().flat_map(|v| v.to_ne_bytes()).collect::<Vec<u8>>())?;
    println!("{}", found.jod);
    Ok(())
}
