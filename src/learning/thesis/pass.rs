//! Forward and backward pass of a network of dense layers through buffers that are kept from batch to batch.

use super::kernels::{Rows, behind, column_sums, dots, layer, outer, transpose};

/// The buffers of one network for batches of one size. Parameters come flat, as [`Mlp`](super::super::mlp::Mlp) keeps
/// them: layer after layer the weights (inputs x outputs) and the bias.
#[derive(Debug)]
pub(super) struct Pass {
    sizes: Vec<usize>,
    /// Where each layer's weights and bias begin among the parameters.
    starts: Vec<[usize; 2]>,
    /// Rectified outputs of each hidden layer.
    hidden: Vec<Vec<f32>>,
    /// Transposed weights of each layer.
    transposed: Vec<Vec<f32>>,
    /// Gradients along the outputs of each hidden layer.
    errors: Vec<Vec<f32>>,
}

impl Pass {
    /// Buffers for a network with layer sizes `sizes`, inputs first, and batches of `rows`.
    pub fn new(sizes: &[usize], rows: usize) -> Self {
        let layers: Vec<[usize; 2]> = sizes.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let mut end = 0;
        let mut starts = Vec::with_capacity(layers.len());
        for [before, after] in &layers {
            starts.push([end, end + before * after]);
            end += (before + 1) * after;
        }
        let hidden: Vec<Vec<f32>> = sizes[1..sizes.len() - 1].iter().map(|units| vec![0.0; rows * units]).collect();
        let transposed = layers.iter().map(|[before, after]| vec![0.0; before * after]).collect();
        Self { sizes: sizes.to_vec(), starts, errors: hidden.clone(), hidden, transposed }
    }

    fn layers(&self) -> usize {
        self.starts.len()
    }

    fn weights<'a>(&self, parameters: &'a [f32], index: usize) -> &'a [f32] {
        let [start, end] = self.starts[index];
        &parameters[start..end]
    }

    fn bias<'a>(&self, parameters: &'a [f32], index: usize) -> &'a [f32] {
        &parameters[self.starts[index][1]..][..self.sizes[index + 1]]
    }

    /// The outputs for `inputs`, written to the beginning of every `stride` values of `out`.
    pub fn forward(&mut self, parameters: &[f32], inputs: Rows<'_>, out: &mut [f32], stride: usize) {
        let last = self.layers() - 1;
        for index in 0..last {
            let (before, rest) = self.hidden.split_at_mut(index);
            let x = before.last().map_or(inputs, |values| Rows::new(values, self.sizes[index]));
            let (from, to) = (self.starts[index], &mut rest[0]);
            let weights = &parameters[from[0]..from[1]];
            layer(x, weights, &parameters[from[1]..][..self.sizes[index + 1]], true, to);
        }
        self.transpose(parameters, last);
        let x = self.hidden.last().map_or(inputs, |values| Rows::new(values, self.sizes[last]));
        dots(x, &self.transposed[last], self.bias(parameters, last), out, stride);
    }

    fn transpose(&mut self, parameters: &[f32], index: usize) {
        let [start, end] = self.starts[index];
        transpose(&parameters[start..end], self.sizes[index + 1], &mut self.transposed[index]);
    }

    /// The parameters' gradient after [`Pass::forward`] with the same parameters and inputs, where `errors` is the
    /// gradient along the outputs.
    pub fn backward(&mut self, parameters: &[f32], inputs: Rows<'_>, errors: &[f32], gradient: &mut [f32]) {
        self.errors_of_hidden_layers(parameters, errors);
        let last = self.layers() - 1;
        for index in 0..=last {
            let [start, middle] = self.starts[index];
            let (before, after) = (self.sizes[index], self.sizes[index + 1]);
            let (weights, bias) = gradient[start..middle + after].split_at_mut(middle - start);
            let x = if index == 0 { inputs } else { Rows::new(&self.hidden[index - 1], before) };
            if index == last {
                // Of few columns the transposed product is the faster one; its transposed weights are needed no more.
                let (errors, scratch) = (Rows::new(errors, after), &mut self.transposed[last]);
                if index == 0 {
                    outer(x, errors, weights);
                } else {
                    outer(errors, x, scratch);
                    transpose(scratch, before, weights);
                }
                column_sums(errors, bias);
            } else {
                let errors = Rows::new(&self.errors[index], after);
                outer(x, errors, weights);
                column_sums(errors, bias);
            }
        }
    }

    /// The gradient along the inputs from number `first` on, after [`Pass::forward`] with the same parameters.
    pub fn backward_to_inputs(&mut self, parameters: &[f32], errors: &[f32], first: usize, out: &mut [f32]) {
        self.errors_of_hidden_layers(parameters, errors);
        let behind_inputs = self.errors.first().map_or(errors, Vec::as_slice);
        let units = self.sizes[1];
        // A weight matrix is its own transposed one's transposed: its rows belong to inputs.
        let weights = &self.weights(parameters, 0)[first * units..];
        let count = self.sizes[0] - first;
        out.fill(0.0);
        dots(Rows::new(behind_inputs, units), weights, &[0.0; MOST_INPUTS][..count], out, count);
    }

    fn errors_of_hidden_layers(&mut self, parameters: &[f32], errors: &[f32]) {
        let last = self.layers() - 1;
        for index in (1..=last).rev() {
            if index < last {
                self.transpose(parameters, index);
            }
            let (before, rest) = self.errors.split_at_mut(index);
            let from = rest.first().map_or(errors, Vec::as_slice);
            let from = Rows::new(from, self.sizes[index + 1]);
            behind(from, &self.transposed[index], &self.hidden[index - 1], &mut before[index - 1]);
        }
    }
}

/// Most inputs along which [`Pass::backward_to_inputs`] gives a gradient.
pub(super) const MOST_INPUTS: usize = 8;
