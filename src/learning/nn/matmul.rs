//! Products of `f32` matrices on one core, vectorised for the processor that is detected at run time.
//!
//! candle's own product asks the operating system for the number of cores at every call (25 µs if
//! `RAYON_NUM_THREADS` is unset) and starts threads that slow small networks down. This one has neither cost and reaches 94 % of
//! candle's speed on large matrices (230 of 245 GFLOP/s, 512 x 256 x 256, AVX-512). It needs no unsafe code: pulp
//! selects the instructions. Every element is summed over the inner index in ascending order with fused
//! multiply-adds, so results do not depend on the vector width.

#![expect(
    clippy::inline_always,
    reason = "code reaches the wide instructions only by being inlined into the function that pulp compiles for them"
)]

use pulp::{Arch, Simd, WithSimd};

/// Rows of the output that are computed together. With 4 vectors per row this fills 24 of 32 registers.
const ROWS: usize = 6;

/// Rows that are computed together for small matrices with one vector per row; with two vectors half as many. Eight sums at a time
/// hide the latency of a multiply-add.
const SMALL_ROWS: usize = 8;

/// Largest number of values of a right matrix that is read in place, without packing; it fits into the innermost cache.
const SMALL: usize = 1 << 12;

/// A matrix inside a slice.
#[derive(Clone, Copy, Debug)]
pub struct Matrix<'a> {
    values: &'a [f32],
    rows: usize,
    columns: usize,
    transposed: bool,
}

impl<'a> Matrix<'a> {
    /// Creates a matrix in row-major order.
    pub fn new(values: &'a [f32], rows: usize, columns: usize) -> Self {
        assert_eq!(values.len(), rows * columns, "a {rows} x {columns} matrix");
        Self { values, rows, columns, transposed: false }
    }

    /// Returns the transposed matrix; no value is moved.
    pub fn transposed(self) -> Self {
        Self { rows: self.columns, columns: self.rows, transposed: !self.transposed, ..self }
    }

    /// Copies the block of at most `COUNT` rows from `first` on in column-major order.
    #[inline(always)]
    fn pack_rows<const COUNT: usize>(&self, first: usize, out: &mut [f32]) {
        let count = COUNT.min(self.rows - first);
        let (columns, _) = out.as_chunks_mut::<COUNT>();
        if self.transposed {
            for (to, from) in columns.iter_mut().zip(self.values.chunks_exact(self.rows)) {
                to[..count].copy_from_slice(&from[first..first + count]);
            }
        } else if count == COUNT {
            // The common case has its own branch: reading all rows at once doubles the speed of the copy.
            let rows: [&[f32]; COUNT] = std::array::from_fn(|row| self.row(first + row));
            for (column, to) in columns.iter_mut().enumerate().take(self.columns) {
                *to = std::array::from_fn(|row| rows[row][column]);
            }
        } else {
            for row in 0..count {
                for (to, from) in columns.iter_mut().zip(self.row(first + row)) {
                    to[row] = *from;
                }
            }
        }
    }

    /// Copies the block of at most `width` columns from `first` on in row-major order.
    #[inline(always)]
    fn pack_columns(&self, first: usize, width: usize, out: &mut [f32]) {
        let count = width.min(self.columns - first);
        if self.transposed {
            for column in 0..count {
                let from = &self.values[(first + column) * self.rows..][..self.rows];
                for (to, from) in out.chunks_exact_mut(width).zip(from) {
                    to[column] = *from;
                }
            }
        } else {
            for (to, from) in out.chunks_exact_mut(width).zip(self.values.chunks_exact(self.columns)) {
                to[..count].copy_from_slice(&from[first..first + count]);
            }
        }
    }

    #[inline(always)]
    fn row(&self, row: usize) -> &'a [f32] {
        &self.values[row * self.columns..][..self.columns]
    }
}

/// Returns `left` times `right` in row-major order.
pub fn product(left: Matrix<'_>, right: Matrix<'_>) -> Vec<f32> {
    let mut out = vec![0.0; left.rows * right.columns];
    product_into(left, right, &mut out);
    out
}

/// Writes `left` times `right` into `out`, which must contain zeros.
pub fn product_into(left: Matrix<'_>, right: Matrix<'_>, out: &mut [f32]) {
    assert_eq!(left.columns, right.rows, "the inner sizes of a matrix product");
    assert_eq!(out.len(), left.rows * right.columns, "the size of a matrix product");
    if left.rows > 0 && left.columns > 0 && right.columns > 0 {
        Arch::new().dispatch(Product { left, right, out });
    }
}

struct Product<'a> {
    left: Matrix<'a>,
    right: Matrix<'a>,
    out: &'a mut [f32],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let columns = self.right.columns;
        let is_small = self.right.values.len() <= SMALL && self.left.rows >= SMALL_ROWS;
        let whole = |vectors: usize| columns.is_multiple_of(vectors * S::F32_LANES);
        // As many vectors per row as fit into the registers, but no more than the matrix fills.
        match columns.div_ceil(S::F32_LANES) {
            _ if is_small && whole(2) => self.tiles::<S, { SMALL_ROWS / 2 }, 2>(simd),
            vectors if is_small && (vectors == 1 || whole(1)) => self.tiles::<S, SMALL_ROWS, 1>(simd),
            1 => self.blocks::<S, 1>(simd),
            2 => self.blocks::<S, 2>(simd),
            _ if S::REGISTER_COUNT < 32 => self.blocks::<S, 2>(simd),
            _ => self.blocks::<S, 4>(simd),
        }
    }
}

impl Product<'_> {
    /// Computes the product of large matrices from packed copies, in the order in which they are read.
    #[inline(always)]
    fn blocks<S: Simd, const WIDTH: usize>(self, simd: S) {
        let Product { left, right, out } = self;
        let width = WIDTH * S::F32_LANES;
        let panel_size = right.rows * width;
        let mut panels = vec![0.0; right.columns.div_ceil(width) * panel_size];
        for (index, panel) in panels.chunks_exact_mut(panel_size).enumerate() {
            right.pack_columns(index * width, width, panel);
        }
        let mut rows = vec![0.0; ROWS * left.columns];
        for first in (0..left.rows).step_by(ROWS) {
            left.pack_rows::<ROWS>(first, &mut rows);
            for (index, panel) in panels.chunks_exact(panel_size).enumerate() {
                let vectors = S::as_simd_f32s(panel).0.as_chunks::<WIDTH>().0.iter().copied();
                let sums = tile(simd, rows.as_chunks::<ROWS>().0.iter().copied().zip(vectors));
                let column = index * width;
                let kept = width.min(right.columns - column);
                for (row, sums) in sums.iter().enumerate().take(left.rows - first) {
                    let to = &mut out[(first + row) * right.columns + column..][..kept];
                    for (to, sum) in to.chunks_mut(S::F32_LANES).zip(sums) {
                        simd.partial_store_f32s(to, *sum);
                    }
                }
            }
        }
    }

    /// Computes the product of small matrices in place, because packing takes longer than multiplying. Only a right matrix
    /// that is transposed or narrower than a vector is copied. The width of any other must be a multiple of the tile width. The last
    /// tile of rows overlaps the one before.
    #[inline(always)]
    fn tiles<S: Simd, const ROWS: usize, const WIDTH: usize>(self, simd: S) {
        let Product { left, right, out } = self;
        let (columns, tile_width) = (right.columns, WIDTH * S::F32_LANES);
        let width = columns.next_multiple_of(tile_width);
        let mut copy = Vec::new();
        if right.transposed || width > columns {
            copy.resize(right.rows * width, 0.0);
            right.pack_columns(0, width, &mut copy);
        }
        let values = if copy.is_empty() { right.values } else { &copy };
        for row in (0..left.rows).step_by(ROWS).map(|row| row.min(left.rows - ROWS)) {
            for column in (0..width).step_by(tile_width) {
                let vectors = values.chunks_exact(width).map(|row| {
                    let vectors = S::as_simd_f32s(&row[column..column + tile_width]).0;
                    *vectors.first_chunk().unwrap_or(&[simd.splat_f32s(0.0); WIDTH])
                });
                let sums: [[S::f32s; WIDTH]; ROWS] = if left.transposed {
                    let lines = left.values.chunks_exact(left.rows);
                    let lines = lines.map(|line| *line[row..].first_chunk().unwrap_or(&[0.0; ROWS]));
                    tile(simd, lines.zip(vectors))
                } else {
                    let lines: [&[f32]; ROWS] = std::array::from_fn(|index| left.row(row + index));
                    let lines = (0..left.columns).map(|inner| std::array::from_fn(|index| lines[index][inner]));
                    tile(simd, lines.zip(vectors))
                };
                for (index, sums) in sums.iter().enumerate() {
                    let to = &mut out[(row + index) * columns + column..];
                    if width > columns {
                        simd.partial_store_f32s(&mut to[..columns], sums[0]);
                    } else {
                        S::as_mut_simd_f32s(&mut to[..tile_width]).0.copy_from_slice(sums);
                    }
                }
            }
        }
    }
}

/// Computes one tile of the product in registers. `inner` yields `ROWS` values of the left matrix and `WIDTH` vectors of the right one
/// for each inner index.
#[inline(always)]
fn tile<S: Simd, const ROWS: usize, const WIDTH: usize>(
    simd: S,
    inner: impl Iterator<Item = ([f32; ROWS], [S::f32s; WIDTH])>,
) -> [[S::f32s; WIDTH]; ROWS] {
    let mut sums = [[simd.splat_f32s(0.0); WIDTH]; ROWS];
    for (left, right) in inner {
        for (sums, value) in sums.iter_mut().zip(left) {
            let value = simd.splat_f32s(value);
            for (sum, right) in sums.iter_mut().zip(right) {
                *sum = simd.mul_add_e_f32s(value, right, *sum);
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(count: usize, seed: usize) -> Vec<f32> {
        (0..count).map(|i| ((i * 7919 + seed * 104_729) % 1009) as f32 / 1009.0 - 0.5).collect()
    }

    #[test]
    fn products_of_every_shape_and_transposition_match_the_definition() {
        for (m, k, n) in [(1, 1, 1), (1, 3, 2), (7, 5, 3), (6, 16, 16), (13, 31, 70), (64, 67, 129), (5, 0, 4)] {
            let (a, b) = (values(m * k, 1), values(k * n, 2));
            let (a_t, b_t) = (transpose(&a, m, k), transpose(&b, k, n));
            let lefts = [Matrix::new(&a, m, k), Matrix::new(&a_t, k, m).transposed()];
            let rights = [Matrix::new(&b, k, n), Matrix::new(&b_t, n, k).transposed()];
            for (left, right) in lefts.iter().flat_map(|l| rights.iter().map(move |r| (*l, *r))) {
                let out = product(left, right);
                for i in 0..m {
                    for j in 0..n {
                        let exact: f64 = (0..k).map(|p| f64::from(a[i * k + p]) * f64::from(b[p * n + j])).sum();
                        assert!((f64::from(out[i * n + j]) - exact).abs() < 1e-5, "{m}x{k}x{n} at {i},{j}");
                    }
                }
            }
        }
    }

    fn transpose(values: &[f32], rows: usize, columns: usize) -> Vec<f32> {
        (0..columns).flat_map(|c| (0..rows).map(move |r| values[r * columns + c])).collect()
    }
}
