//! In which sizes stimuli were shown, as answers say it.

use crate::error::StoreError;
use crate::sqlite::Store;
use rusqlite::Row;

/// The answers of one session to stimuli of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownSize {
    /// Session's id.
    pub session_id: String,
    /// [width, height] in pixels; [0, 0] where that was never known.
    pub size: [u32; 2],
    /// How many.
    pub answers: u64,
    /// Least and greatest device pixels a stimulus pixel, where pages said so.
    pub scale: Option<[f64; 2]>,
    /// Least and greatest width, CSS px, where pages said so.
    pub css_width_px: Option<[f64; 2]>,
    /// Greatest refresh rate that pages measured, Hz.
    pub refresh_hz: Option<f64>,
}

/// A number of a payload within the bounds of its column; null for anything else.
fn number(payload: &str, field: &str, most: f64) -> String {
    format!(
        "CASE WHEN json_valid({payload}) AND json_type({payload}, '$.{field}') IN ('real', 'integer')
         AND json_extract({payload}, '$.{field}') BETWEEN 0 AND {most} THEN json_extract({payload}, '$.{field}') END"
    )
}

impl Store {
    /// How many answers to these versions of a study were given at which size, and how large that was on displays; by session and size.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn shown_sizes(
        &self,
        study_id: &str,
        versions: &[String],
    ) -> Result<Vec<ShownSize>, StoreError> {
        let versions = serde_json::to_string(versions).map_err(|e| StoreError::corrupt("versions", e))?;
        let [scale, width, rate] = [("scale", 100.0), ("css_width_px", 1e6), ("refresh_hz", 1e4)]
            .map(|(field, most)| number("payload", field, most));
        let of = "s.study_id = ?1 AND s.version IN (SELECT value FROM json_each(?2))";
        let query = format!(
            "WITH given AS (
                 SELECT r.session_id, r.left_sha256 AS sha256, p.payload FROM responses r JOIN sessions s USING (session_id)
                 LEFT JOIN response_payloads p USING (response_id) WHERE {of}
                 UNION ALL
                 SELECT a.session_id, (SELECT json_extract(value, '$.sha256') FROM json_each(a.row, '$[5]') LIMIT 1), c.payload
                 FROM answers a JOIN sessions s USING (session_id)
                 LEFT JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq WHERE {of} AND json_valid(a.row)
             ), told AS (SELECT session_id, sha256, {scale} AS scale, {width} AS css_width, {rate} AS rate FROM given)
             SELECT session_id, coalesce(t.width, 0), coalesce(t.height, 0), count(*), min(scale), max(scale), min(css_width), max(css_width), max(rate)
             FROM told LEFT JOIN stimuli t USING (sha256) GROUP BY 1, 2, 3 ORDER BY 1, 2, 3"
        );
        let study_id = study_id.to_owned();
        let read = self.readers.read(move |reader| {
            let mut query = reader.prepare(&query)?;
            let rows = query.query_map((study_id, versions), shown)?;
            Ok(rows.collect::<Result<Vec<ShownSize>, _>>()?)
        });
        read.await
    }
}

fn shown(row: &Row<'_>) -> Result<ShownSize, rusqlite::Error> {
    let range = |at: usize| -> Result<Option<[f64; 2]>, rusqlite::Error> {
        Ok(Option::zip(row.get(at)?, row.get(at + 1)?).map(|(low, high)| [low, high]))
    };
    Ok(ShownSize {
        session_id: row.get(0)?,
        size: [row.get(1)?, row.get(2)?],
        answers: row.get::<_, i64>(3)?.unsigned_abs(),
        scale: range(4)?,
        css_width_px: range(6)?,
        refresh_hz: row.get(8)?,
    })
}
