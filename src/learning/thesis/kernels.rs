//! Products of small `f32` matrices that are written where they are needed: nothing is packed, copied or allocated.
//!
//! Beside [`matmul`](super::super::matmul) these suit networks that fit into the cache: a layer of 16 units is one or
//! two vectors wide, and copying it takes longer than multiplying it. What follows a product in a network (bias and
//! rectified linear unit, or the mask of one) happens while the sums are still in registers.

#![expect(
    clippy::inline_always,
    reason = "code reaches the wide instructions only by being inlined into the function that pulp compiles for them"
)]

use pulp::{Arch, Simd, WithSimd};

/// Samples, one a row of `columns` values; rows begin `stride` values apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    values: &'a [f32],
    stride: usize,
    columns: usize,
}

impl<'a> Rows<'a> {
    /// Rows that lie one after the other.
    pub fn new(values: &'a [f32], columns: usize) -> Self {
        Self { values, stride: columns, columns }
    }

    /// The first `columns` values of every row.
    pub fn first(self, columns: usize) -> Self {
        assert!(columns <= self.columns, "{columns} columns of {}", self.columns);
        Self { columns, ..self }
    }

    fn count(&self) -> usize {
        self.values.len() / self.stride
    }

    #[inline(always)]
    fn row(&self, row: usize) -> &'a [f32] {
        &self.values[row * self.stride..][..self.columns]
    }
}

/// A layer: `x W + b` for every row x, rectified where `rectified` says so. `weights` lie row after row (inputs x
/// outputs).
pub(super) fn layer(x: Rows<'_>, weights: &[f32], bias: &[f32], rectified: bool, out: &mut [f32]) {
    let least = if rectified { 0.0 } else { f32::NEG_INFINITY };
    let finish = Bias { bias, least };
    run(Job { left: x, by_columns: false, right: weights, columns: bias.len(), finish, out });
}

/// The gradient before a layer from that behind it: `d W^T`, nought where the layer's input, a rectified output, is.
/// `transposed` is `W^T`, row after row.
pub(super) fn behind(errors: Rows<'_>, transposed: &[f32], inputs: &[f32], out: &mut [f32]) {
    let columns = transposed.len() / errors.columns;
    run(Job { left: errors, by_columns: false, right: transposed, columns, finish: Mask(inputs), out });
}

/// The gradient of a layer's weights: `x^T d`, summed over the rows.
pub(super) fn outer(x: Rows<'_>, errors: Rows<'_>, out: &mut [f32]) {
    assert_eq!(errors.stride, errors.columns, "rows that lie one after the other");
    run(Job { left: x, by_columns: true, right: errors.values, columns: errors.columns, finish: Keep, out });
}

/// A layer of few outputs: for every row the dot products with the rows of `transposed` (outputs x inputs), plus
/// `bias`, written to the beginning of every `stride` values of `out`. Sixteen sums a product on every processor, so
/// that results do not depend on the width of its vectors.
pub(super) fn dots(x: Rows<'_>, transposed: &[f32], bias: &[f32], out: &mut [f32], stride: usize) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (row, to) in out.chunks_mut(stride).enumerate().take(x.count()) {
                let row = x.row(row);
                for ((to, weights), bias) in to.iter_mut().zip(transposed.chunks_exact(x.columns)).zip(bias) {
                    *to = bias + dot(row, weights);
                }
            }
        },
    );
}

#[inline(always)]
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<16>(), b.as_chunks::<16>());
    let mut sums = [0.0f32; 16];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..16 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let mut half = 8;
    while half > 0 {
        for lane in 0..half {
            sums[lane] += sums[lane + half];
        }
        half /= 2;
    }
    sums[0] + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f32>()
}

/// Sums over the rows: the gradient of a bias.
pub(super) fn column_sums(errors: Rows<'_>, out: &mut [f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            out.fill(0.0);
            for row in 0..errors.count() {
                for (sum, error) in out.iter_mut().zip(errors.row(row)) {
                    *sum += error;
                }
            }
        },
    );
}

/// Copies a matrix of `columns` columns to its transposed one.
pub(super) fn transpose(values: &[f32], columns: usize, out: &mut [f32]) {
    let rows = values.len() / columns;
    // Sixteen rows at a time fill whole lines of the cache.
    for (block, values) in values.chunks(16 * columns).enumerate() {
        for (column, to) in out.chunks_exact_mut(rows).enumerate() {
            for (to, from) in to[16 * block..].iter_mut().zip(values.iter().skip(column).step_by(columns)) {
                *to = *from;
            }
        }
    }
}

/// What happens to sums before they are stored: those of a tile's line, which stand in columns from `column` on and at
/// `place` in the output. A type and not a value, so that nothing is asked in the loops.
trait Finish: Copy {
    fn apply<S: Simd, const WIDTH: usize, const WHOLE: bool>(
        self,
        simd: S,
        sums: [S::f32s; WIDTH],
        column: usize,
        place: usize,
    ) -> [S::f32s; WIDTH];
}

#[derive(Clone, Copy)]
struct Keep;

impl Finish for Keep {
    #[inline(always)]
    fn apply<S: Simd, const WIDTH: usize, const WHOLE: bool>(
        self,
        _: S,
        sums: [S::f32s; WIDTH],
        _: usize,
        _: usize,
    ) -> [S::f32s; WIDTH] {
        sums
    }
}

/// Adds a bias and cuts off below `least`.
#[derive(Clone, Copy)]
struct Bias<'a> {
    bias: &'a [f32],
    least: f32,
}

impl Finish for Bias<'_> {
    #[inline(always)]
    fn apply<S: Simd, const WIDTH: usize, const WHOLE: bool>(
        self,
        simd: S,
        sums: [S::f32s; WIDTH],
        column: usize,
        _: usize,
    ) -> [S::f32s; WIDTH] {
        let (bias, least) = (load::<S, WIDTH, WHOLE>(simd, &self.bias[column..]), simd.splat_f32s(self.least));
        std::array::from_fn(
            #[inline(always)]
            |index| simd.max_f32s(simd.add_f32s(sums[index], bias[index]), least),
        )
    }
}

/// Leaves nought where a rectified output is nought.
#[derive(Clone, Copy)]
struct Mask<'a>(&'a [f32]);

impl Finish for Mask<'_> {
    #[inline(always)]
    fn apply<S: Simd, const WIDTH: usize, const WHOLE: bool>(
        self,
        simd: S,
        sums: [S::f32s; WIDTH],
        _: usize,
        place: usize,
    ) -> [S::f32s; WIDTH] {
        let (outputs, nought) = (load::<S, WIDTH, WHOLE>(simd, &self.0[place..]), simd.splat_f32s(0.0));
        std::array::from_fn(
            #[inline(always)]
            |index| simd.select_f32s(simd.greater_than_f32s(outputs[index], nought), sums[index], nought),
        )
    }
}

/// `left` (or its transposed, `by_columns`) times `right`, a matrix of `columns` columns.
struct Job<'a, F> {
    left: Rows<'a>,
    by_columns: bool,
    right: &'a [f32],
    columns: usize,
    finish: F,
    out: &'a mut [f32],
}

impl<F: Finish> Job<'_, F> {
    fn rows(&self) -> usize {
        if self.by_columns { self.left.columns } else { self.left.count() }
    }

    fn inner(&self) -> usize {
        if self.by_columns { self.left.count() } else { self.left.columns }
    }
}

fn run<F: Finish>(job: Job<'_, F>) {
    assert_eq!(job.right.len(), job.inner() * job.columns, "the inner sizes of a product");
    assert_eq!(job.out.len(), job.rows() * job.columns, "the size of a product");
    if !job.out.is_empty() {
        Arch::new().dispatch(job);
    }
}

impl<F: Finish> WithSimd for Job<'_, F> {
    type Output = ();

    /// Eight sums at a time hide how long a multiply-add takes. Tiles of one vector a row beat wider ones here, from
    /// layers of 16 to layers of 256 units: their part of the right matrix is small enough for the innermost cache.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (rows, vectors) = (self.rows(), self.columns / S::F32_LANES);
        match (self.by_columns, rows) {
            (false, _) if vectors == 0 => self.tiles::<S, 1, 1, false, false>(simd),
            (true, _) if vectors == 0 => self.tiles::<S, 1, 1, true, false>(simd),
            (false, 8..) => self.tiles::<S, 8, 1, false, true>(simd),
            (true, 8..) => self.tiles::<S, 8, 1, true, true>(simd),
            (true, 4..) => self.tiles::<S, 4, 1, true, true>(simd),
            (true, _) if vectors >= 2 => self.tiles::<S, 1, 2, true, true>(simd),
            (false, _) => self.tiles::<S, 1, 1, false, true>(simd),
            (true, _) => self.tiles::<S, 1, 1, true, true>(simd),
        }
    }
}

impl<F: Finish> Job<'_, F> {
    /// The product in tiles of `ROWS` rows and `WIDTH` vectors. The last ones overlap those before, so that all are
    /// whole; only a matrix narrower than a vector is loaded in part, and then not `WHOLE`.
    #[inline(always)]
    fn tiles<S: Simd, const ROWS: usize, const WIDTH: usize, const BY_COLUMNS: bool, const WHOLE: bool>(self, simd: S) {
        let (rows, columns, inner) = (self.rows(), self.columns, self.inner());
        let Job { left, right, finish, out, .. } = self;
        let width = if WHOLE { WIDTH * S::F32_LANES } else { columns };
        for column in steps(columns, width) {
            for row in steps(rows, ROWS) {
                let panel = right[column..].chunks(columns).take(inner);
                let mut sums = [[simd.splat_f32s(0.0); WIDTH]; ROWS];
                if BY_COLUMNS {
                    for (right, left) in panel.zip(left.values.chunks(left.stride)) {
                        let right = load::<S, WIDTH, WHOLE>(simd, right);
                        let Some(left) = left[row..].first_chunk::<ROWS>() else { break };
                        for (sums, value) in sums.iter_mut().zip(left) {
                            add_product(simd, *value, &right, sums);
                        }
                    }
                } else {
                    let lines: [&[f32]; ROWS] = std::array::from_fn(|line| &left.row(row + line)[..inner]);
                    for (index, right) in panel.enumerate() {
                        let right = load::<S, WIDTH, WHOLE>(simd, right);
                        for (sums, line) in sums.iter_mut().zip(&lines) {
                            add_product(simd, line[index], &right, sums);
                        }
                    }
                }
                for (line, sums) in sums.iter().enumerate() {
                    let start = (row + line) * columns + column;
                    let values = finish.apply::<S, WIDTH, WHOLE>(simd, *sums, column, start);
                    store::<S, WIDTH, WHOLE>(simd, values, &mut out[start..start + width]);
                }
            }
        }
    }
}

/// Where blocks of `size` begin that cover `count`; the last one ends with it.
fn steps(count: usize, size: usize) -> impl Iterator<Item = usize> {
    (0..count).step_by(size).map(move |start| start.min(count - size))
}

#[inline(always)]
fn add_product<S: Simd, const WIDTH: usize>(simd: S, left: f32, right: &[S::f32s; WIDTH], sums: &mut [S::f32s; WIDTH]) {
    let left = simd.splat_f32s(left);
    for (sum, right) in sums.iter_mut().zip(right) {
        *sum = simd.mul_add_e_f32s(left, *right, *sum);
    }
}

/// The vectors at the beginning of `values`, or the part of one that there is.
#[inline(always)]
fn load<S: Simd, const WIDTH: usize, const WHOLE: bool>(simd: S, values: &[f32]) -> [S::f32s; WIDTH] {
    if WHOLE {
        let (vectors, _) = S::as_simd_f32s(&values[..WIDTH * S::F32_LANES]);
        std::array::from_fn(
            #[inline(always)]
            |index| vectors[index],
        )
    } else {
        [simd.partial_load_f32s(&values[..values.len().min(S::F32_LANES)]); WIDTH]
    }
}

#[inline(always)]
fn store<S: Simd, const WIDTH: usize, const WHOLE: bool>(simd: S, vectors: [S::f32s; WIDTH], to: &mut [f32]) {
    if WHOLE {
        let (to, _) = S::as_mut_simd_f32s(&mut to[..WIDTH * S::F32_LANES]);
        for (to, vector) in to.iter_mut().zip(vectors) {
            *to = vector;
        }
    } else {
        simd.partial_store_f32s(to, vectors[0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(count: usize, seed: usize) -> Vec<f32> {
        (0..count).map(|i| ((i * 7919 + seed * 104_729) % 1009) as f32 / 1009.0 - 0.5).collect()
    }

    /// Sum over p of `a(i, p)` times `b(p, j)`.
    fn sum(inner: usize, a: impl Fn(usize) -> f32, b: impl Fn(usize) -> f32) -> f32 {
        (0..inner).map(|p| f64::from(a(p)) * f64::from(b(p))).sum::<f64>() as f32
    }

    #[test]
    fn every_kernel_does_what_its_definition_says_for_every_shape() {
        for (m, k, n) in [(1, 1, 1), (3, 2, 5), (9, 6, 16), (32, 8, 32), (5, 40, 2), (33, 17, 70), (2, 3, 37)] {
            let (x, w, bias, d) = (values(m * (k + 2), 1), values(k * n, 2), values(n, 3), values(m * n, 4));
            let x_rows = Rows::new(&x, k + 2).first(k);
            let mut transposed = vec![0.0; k * n];
            transpose(&w, n, &mut transposed);
            let close = |a: f32, b: f32, what: &str| assert!((a - b).abs() < 1e-5, "{what} {m}x{k}x{n}: {a}, {b}");
            let (mut y, mut few, mut product) = (vec![9.0; m * n], vec![9.0; m * n], vec![9.0; k * n]);
            layer(x_rows, &w, &bias, true, &mut y);
            dots(x_rows, &transposed, &bias, &mut few, n);
            for i in 0..m {
                for j in 0..n {
                    let exact = bias[j] + sum(k, |p| x[i * (k + 2) + p], |p| w[p * n + j]);
                    close(y[i * n + j], exact.max(0.0), "layer");
                    close(few[i * n + j], exact, "dots");
                }
            }
            outer(x_rows, Rows::new(&d, n), &mut product);
            for (place, value) in product.iter().enumerate() {
                let (p, j) = (place / n, place % n);
                close(*value, sum(m, |i| x[i * (k + 2) + p], |i| d[i * n + j]), "outer");
            }
            let (inputs, mut back) = (values(m * k, 5), vec![9.0; m * k]);
            behind(Rows::new(&d, n), &transposed, &inputs, &mut back);
            for (place, value) in back.iter().enumerate() {
                let (i, p) = (place / k, place % k);
                let exact = sum(n, |j| d[i * n + j], |j| w[p * n + j]);
                close(*value, if inputs[place] > 0.0 { exact } else { 0.0 }, "behind");
            }
            let mut sums = vec![9.0; n];
            column_sums(Rows::new(&d, n), &mut sums);
            sums.iter().enumerate().for_each(|(j, s)| close(*s, sum(m, |i| d[i * n + j], |_| 1.0), "column sums"));
        }
    }
}
