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

/// A rectangle on the page: left, upper, right and lower edge, px.
type Area = [f64; 4];

fn meet(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Where the label of each point stands: its left middle, px. `points` are places with the width of their label, 0 for none; a label stands
/// beside its point, on whichever side it covers no other label and no point, and keeps between the columns `within`.
pub(crate) fn beside(points: &[(f64, f64, f64)], height: f64, within: [f64; 2]) -> Vec<(f64, f64)> {
    const GAP: f64 = 8.0;
    let marks: Vec<Area> = points.iter().map(|(x, y, _)| [x - 5.0, y - 5.0, x + 5.0, y + 5.0]).collect();
    let mut taken: Vec<Area> = Vec::new();
    points
        .iter()
        .map(|&(x, y, width)| {
            let first = (x + GAP, y - GAP);
            if width <= 0.0 {
                return first;
            }
            let heights = [-GAP, GAP, -GAP - height, GAP + height, -GAP - 2.0 * height, GAP + 2.0 * height];
            let places = heights.iter().flat_map(|dy| [(x + GAP, y + dy), (x - GAP - width, y + dy)]);
            let area = |(left, middle): (f64, f64)| {
                [left, middle - height / 2.0, left + width, middle + height / 2.0]
            };
            let free = |place: &(f64, f64)| {
                let area = area(*place);
                area[0] >= within[0]
                    && area[2] <= within[1]
                    && !taken.iter().chain(&marks).any(|other| meet(&area, other))
            };
            let chosen = places.clone().find(free).unwrap_or(first);
            taken.push(area(chosen));
            chosen
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_near_points_stand_apart() {
        // Three points in one spot and one far away at the right edge.
        let points = [(50.0, 50.0, 60.0), (51.0, 50.0, 60.0), (52.0, 51.0, 60.0), (190.0, 50.0, 60.0)];
        let places = beside(&points, 16.0, [0.0, 200.0]);
        let areas: Vec<Area> = places.iter().map(|(x, y)| [*x, y - 8.0, x + 60.0, y + 8.0]).collect();
        for (k, area) in areas.iter().enumerate() {
            assert!(areas[..k].iter().all(|other| !meet(area, other)), "{areas:?}");
        }
        assert_eq!(places[0], (58.0, 42.0), "a label that has room stands at the upper right");
        assert!(places[3].0 < 190.0, "the last one turns to the left, inside the figure");
        // Control: side by side without the search they would cover each other.
        let naive = |(x, y, width): (f64, f64, f64)| [x + 8.0, y - 16.0, x + 8.0 + width, y];
        assert!(meet(&naive(points[0]), &naive(points[1])));
    }

    #[test]
    fn crowded_labels_move_apart_and_lonely_ones_stay() {
        assert_eq!(spread(&[10.0, 12.0, 80.0], 14.0, [0.0, 100.0]), [10.0, 24.0, 80.0]);
        assert_eq!(spread(&[99.0, 98.0], 14.0, [0.0, 100.0]), [100.0, 86.0]);
    }
}
