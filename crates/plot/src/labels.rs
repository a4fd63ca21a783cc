//! Labels beside lines, moved apart where they would cover each other.

/// Heights for labels that want to stand at `wanted` px, at least `apart` px from one another and within `within`; the order is kept.
pub(crate) fn spread(wanted: &[f64], apart: f64, within: [f64; 2]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|a, b| wanted[*a].total_cmp(&wanted[*b]));
    // Downwards each makes room for the one before it; then back up from the lower end.
    let mut placed: Vec<f64> = Vec::with_capacity(order.len());
    for index in &order {
        let least = placed.last().map_or(within[0], |above| above + apart);
        placed.push(wanted[*index].max(least));
    }
    let mut most = within[1];
    for place in placed.iter_mut().rev() {
        *place = place.min(most);
        most = *place - apart;
    }
    let mut heights = vec![0.0; wanted.len()];
    for (index, place) in order.into_iter().zip(placed) {
        heights[index] = place;
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_labels_move_apart_and_lonely_ones_stay() {
        assert_eq!(spread(&[10.0, 12.0, 80.0], 14.0, [0.0, 100.0]), [10.0, 24.0, 80.0]);
        assert_eq!(spread(&[99.0, 98.0], 14.0, [0.0, 100.0]), [100.0, 86.0]);
    }
}
