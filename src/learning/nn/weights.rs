//! Named arrays and a JSON note in a safetensors file: the format of policies and checkpoints.

use std::collections::HashMap;

use candle_core::{DType, Device, Tensor};
use safetensors::{Dtype, SafeTensorError, SafeTensors, tensor::TensorView};
use serde::{Serialize, de::DeserializeOwned};

use super::{
    adam::{Adam, AdamConfig},
    first_line,
    mlp::Mlp,
};
use crate::learning::settings::SettingError;

/// The only metadata key. Its value is one JSON text with the whole note: the order of several keys in a file is random, so
/// equal runs would produce unequal files.
const NOTE: &str = "carom";

/// The content of a weights file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum WeightsError {
    /// Not a safetensors file, or a damaged one.
    #[error("it is not a whole safetensors file ({0})")]
    Format(#[from] SafeTensorError),
    /// A safetensors file with another content.
    #[error("its metadata has no \"carom\" entry of the right kind")]
    Metadata,
    /// An array is missing, or its type or shape is not the expected one.
    #[error("its array \"{name}\" is not {expected}")]
    Array {
        /// The array's name.
        name: String,
        /// Expected type or shape.
        expected: String,
    },
    /// The layers of a network are not the expected ones.
    #[error("its network \"{name}\" has {found}, and the settings ask for {wanted}")]
    Shape {
        /// The network's name.
        name: String,
        /// Layers in the file, or the number of values if the layers are unknown.
        found: String,
        /// Expected layers.
        wanted: String,
    },
    /// candle reports an error.
    #[error("candle refuses its networks ({})", first_line(.0))]
    Network(#[from] candle_core::Error),
    /// A setting of the agent in the file is refused.
    #[error("a setting in it is refused: {0}")]
    Settings(#[from] SettingError),
    /// A weight is NaN or infinite.
    #[error("its array \"{0}\" holds a value that is not a finite number")]
    NotFinite(String),
}

/// Collects arrays for a file.
#[derive(Debug, Default)]
pub struct Writer {
    arrays: Vec<(String, Dtype, Vec<usize>, Vec<u8>)>,
}

impl Writer {
    /// Adds an array of `f32`.
    pub fn add(&mut self, name: impl Into<String>, shape: &[usize], values: &[f32]) {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.arrays.push((name.into(), Dtype::F32, shape.to_vec(), bytes));
    }

    /// Adds an array of `f64`.
    pub(crate) fn add_f64(&mut self, name: impl Into<String>, shape: &[usize], values: &[f64]) {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.arrays.push((name.into(), Dtype::F64, shape.to_vec(), bytes));
    }

    /// Adds a network layer by layer: `name.0.weight` (inputs x outputs), `name.0.bias`, and so on.
    pub(crate) fn add_network(&mut self, name: &str, network: &Mlp) -> Result<(), WeightsError> {
        for (name, shape, values) in layers(name, network)? {
            self.add(name, &shape, &values);
        }
        Ok(())
    }

    /// Adds a network in half precision (16 bits per value), for networks whose training is finished.
    pub(crate) fn add_network_half(&mut self, name: &str, network: &Mlp) -> Result<(), WeightsError> {
        for (name, shape, values) in layers(name, network)? {
            let mut bytes = Vec::with_capacity(2 * values.len());
            let values = Tensor::from_vec(values, shape.as_slice(), &Device::Cpu)?;
            values.to_dtype(DType::F16)?.write_bytes(&mut bytes)?;
            self.arrays.push((name, Dtype::F16, shape, bytes));
        }
        Ok(())
    }

    /// Adds the state of a network's optimiser as `name.moment.0` and `name.moment.1`, or `moment.0` and `moment.1` if `name` is empty.
    pub(crate) fn add_optimiser(&mut self, name: &str, optimiser: &Adam) -> Result<(), WeightsError> {
        for pair in optimiser.moments() {
            for (order, moment) in pair.iter().enumerate() {
                self.add(moment_name(name, order), moment.dims(), &moment.to_vec1()?);
            }
        }
        Ok(())
    }

    /// Returns the file's bytes, with a note that [`Reader::note`] returns.
    ///
    /// # Errors
    /// The errors of safetensors.
    pub fn finish(&self, note: &impl Serialize) -> Result<Vec<u8>, WeightsError> {
        let note = serde_json::to_string(note).map_err(SafeTensorError::from)?;
        let views = self.arrays.iter().map(|(name, dtype, shape, bytes)| {
            TensorView::new(*dtype, shape.clone(), bytes).map(|view| (name.as_str(), view))
        });
        let views = views.collect::<Result<Vec<_>, _>>()?;
        Ok(safetensors::serialize(views, Some(HashMap::from([(NOTE.to_owned(), note)])))?)
    }
}

/// The arrays and the note of a file.
#[derive(Debug)]
pub struct Reader<'a> {
    arrays: SafeTensors<'a>,
    note: String,
}

impl<'a> Reader<'a> {
    /// Parses the file of a [`Writer`].
    ///
    /// # Errors
    /// [`WeightsError::Format`] or [`WeightsError::Metadata`].
    pub fn new(bytes: &'a [u8]) -> Result<Self, WeightsError> {
        let (_, metadata) = SafeTensors::read_metadata(bytes)?;
        let note = metadata.metadata().as_ref().and_then(|entries| entries.get(NOTE)).ok_or(WeightsError::Metadata)?;
        Ok(Self { arrays: SafeTensors::deserialize(bytes)?, note: note.clone() })
    }

    /// Parses the note.
    ///
    /// # Errors
    /// [`WeightsError::Metadata`] if the note is not a `T`.
    pub fn note<T: DeserializeOwned>(&self) -> Result<T, WeightsError> {
        serde_json::from_str(&self.note).map_err(|_| WeightsError::Metadata)
    }

    /// Whether there is an array called `name`.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.arrays.tensor(name).is_ok()
    }

    /// Returns the shape and the values of an array of `f32` or of half precision.
    ///
    /// # Errors
    /// [`WeightsError::Array`] or [`WeightsError::NotFinite`].
    pub fn array(&self, name: &str) -> Result<(Vec<usize>, Vec<f32>), WeightsError> {
        let array = self
            .typed(name, Dtype::F32, "an array of 32-bit numbers")
            .or_else(|error| self.typed(name, Dtype::F16, "").map_err(|_| error))?;
        let digits = if array.dtype() == Dtype::F16 { DType::F16 } else { DType::F32 };
        let values = Tensor::from_raw_buffer(array.data(), digits, array.shape(), &Device::Cpu)?;
        let values: Vec<f32> = values.to_dtype(DType::F32)?.flatten_all()?.to_vec1()?;
        if values.iter().all(|value| value.is_finite()) {
            Ok((array.shape().to_vec(), values))
        } else {
            Err(WeightsError::NotFinite(name.to_owned()))
        }
    }

    /// Returns the values of an array of `f64`.
    pub(crate) fn array_f64(&self, name: &str) -> Result<Vec<f64>, WeightsError> {
        let array = self.typed(name, Dtype::F64, "an array of 64-bit numbers")?;
        let (values, _) = array.data().as_chunks::<8>();
        Ok(values.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect())
    }

    fn typed(&self, name: &str, dtype: Dtype, expected: &str) -> Result<TensorView<'a>, WeightsError> {
        match self.arrays.tensor(name) {
            Ok(array) if array.dtype() == dtype => Ok(array),
            _ => Err(WeightsError::Array { name: name.to_owned(), expected: expected.to_owned() }),
        }
    }

    /// Returns the network that [`Writer::add_network`] wrote. Its layers must have these `sizes`, inputs first.
    ///
    /// # Errors
    /// Fails if the sizes differ or an array is missing.
    pub(crate) fn network(&self, name: &str, sizes: &[usize]) -> Result<Mlp, WeightsError> {
        let weight = |layer: usize| format!("{name}.{layer}.weight");
        let shapes = (0..).map_while(|layer| Some(self.arrays.tensor(&weight(layer)).ok()?.shape().to_vec()));
        let found: Vec<_> = shapes.collect();
        let fits = !sizes.contains(&0) && found.iter().map(Vec::as_slice).eq(sizes.windows(2));
        if !found.is_empty() && !fits {
            let inputs = found[0].first().into_iter();
            let found = units(inputs.chain(found.iter().filter_map(|shape| shape.last())));
            return Err(WeightsError::Shape { name: name.to_owned(), found, wanted: units(sizes) });
        }
        let mut parameters = Vec::new();
        for (layer, pair) in sizes.windows(2).enumerate() {
            parameters.extend(self.array(&weight(layer))?.1);
            let name = format!("{name}.{layer}.bias");
            let (shape, bias) = self.array(&name)?;
            if shape != pair[1..] {
                return Err(WeightsError::Array { name, expected: format!("{} values", pair[1]) });
            }
            parameters.extend(bias);
        }
        Ok(Mlp::from_parameters(sizes, parameters)?)
    }

    /// Returns the optimiser of `network` that `Writer::add_optimiser` wrote after `steps` steps.
    ///
    /// # Errors
    /// Fails if an array is missing or does not fit the network.
    pub fn optimiser(&self, name: &str, network: &Mlp, config: AdamConfig, steps: u32) -> Result<Adam, WeightsError> {
        let moment = |order: usize| -> Result<Tensor, WeightsError> {
            let name = moment_name(name, order);
            let (_, values) = self.array(&name)?;
            let expected = network.parameters().elem_count();
            if values.len() != expected {
                return Err(WeightsError::Array { name, expected: format!("{expected} values") });
            }
            Ok(Tensor::from_vec(values, expected, &Device::Cpu)?)
        };
        let moments = vec![[moment(0)?, moment(1)?]];
        Ok(Adam::resume(vec![network.parameters().clone()], config, moments, steps))
    }
}

/// Name, shape and values.
type Array = (String, Vec<usize>, Vec<f32>);

/// Splits a network into arrays, layer by layer: the weights, then the bias.
fn layers(name: &str, network: &Mlp) -> Result<Vec<Array>, WeightsError> {
    let (mut rest, mut arrays) = (network.parameters().to_vec1::<f32>()?, Vec::new());
    for (layer, pair) in network.sizes().windows(2).enumerate() {
        for (part, shape) in [("weight", pair), ("bias", &pair[1..])] {
            let after = rest.split_off(shape.iter().product());
            arrays.push((format!("{name}.{layer}.{part}"), shape.to_vec(), rest));
            rest = after;
        }
    }
    Ok(arrays)
}

/// Describes layer sizes in words.
pub(crate) fn units<'a>(sizes: impl IntoIterator<Item = &'a usize>) -> String {
    let sizes: Vec<_> = sizes.into_iter().map(usize::to_string).collect();
    format!("layers of {} units", sizes.join("-"))
}

fn moment_name(optimiser: &str, order: usize) -> String {
    let point = if optimiser.is_empty() { "" } else { "." };
    format!("{optimiser}{point}moment.{order}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn half_precision_halves_the_file_and_keeps_three_digits() {
        let mlp = Mlp::random(&[30, 40, 2], &mut Xoshiro256PlusPlus::seed_from_u64(1)).unwrap();
        let file = |mlp: &Mlp| {
            let mut writer = Writer::default();
            writer.add_network_half("actor", mlp).unwrap();
            writer.finish(&"a note").unwrap()
        };
        let bytes = file(&mlp);
        assert!(bytes.len() < 2 * mlp.parameters().elem_count() + 700, "{} bytes", bytes.len());
        let read = Reader::new(&bytes).unwrap().network("actor", mlp.sizes()).unwrap();
        let values = |mlp: &Mlp| mlp.parameters().to_vec1::<f32>().unwrap();
        assert!(
            values(&read).iter().zip(values(&mlp)).all(|(read, own)| (read - own).abs() <= 5e-4 * own.abs() + 1e-7)
        );
        assert_eq!(file(&read), bytes, "rounded values must not change when they are rounded again");
    }

    #[test]
    fn damaged_and_foreign_files_are_refused_with_a_reason() {
        let mut writer = Writer::default();
        let mlp = Mlp::random(&[3, 4, 2], &mut Xoshiro256PlusPlus::seed_from_u64(1)).unwrap();
        writer.add_network("actor", &mlp).unwrap();
        writer.add("extra", &[1], &[f32::NAN]);
        writer.add_f64("exact", &[1], &[0.1]);
        let bytes = writer.finish(&"a note").unwrap();
        let reader = Reader::new(&bytes).unwrap();
        assert!(matches!(reader.array("extra"), Err(WeightsError::NotFinite(_))));
        assert!(reader.array("exact").unwrap_err().to_string().contains("32-bit"));
        let refused = reader.network("actor", &[3, 5, 2]).unwrap_err().to_string();
        assert!(refused.contains("3-5-2") && refused.contains("3-4-2"), "{refused}");
        assert!(reader.network("critic", &[3, 4, 2]).unwrap_err().to_string().contains("critic.0.weight"));
        assert!(matches!(reader.note::<usize>(), Err(WeightsError::Metadata)));
        for cut in [0, 7, 20, bytes.len() - 1] {
            assert!(Reader::new(&bytes[..cut]).is_err(), "cut at {cut}");
        }
        let foreign = safetensors::serialize(Vec::<(String, TensorView)>::new(), None).unwrap();
        assert!(matches!(Reader::new(&foreign), Err(WeightsError::Metadata)));
    }
}
