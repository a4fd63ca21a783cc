//! A data folder is opened, which brings its layout up to date.

use crate::connection::{self, BUSY, DATABASE};
use crate::error::StoreError;
use crate::files::Files;
use crate::layout;
use crate::place::Place;
use crate::private;
use crate::readers::Readers;
use crate::sqlite::Store;
use crate::threads::blocking;
use crate::writer::Writer;
use sqlx::sqlite::{SqliteConnectOptions, SqlitePoolOptions};
use std::path::Path;

// Here and not beside `Store`: the layout is brought up to date by what reads and writes one.
impl Store {
    /// Opens `folder`, which it makes if need be, with `kelir.sqlite` and `stimuli/` inside, and brings the layout up to date.
    ///
    /// # Errors
    /// The folder or the database cannot be opened, was written by a newer version, or holds what cannot be brought over; it is as it was.
    pub async fn open(folder: &Path) -> Result<Store, StoreError> {
        private::folder(folder)?;
        private::close(folder);
        let files = Files::open(folder.join("stimuli"))?;
        let path = folder.join(DATABASE);
        let (database, stimuli) = (path.clone(), files.clone());
        blocking(move || layout::bring_up_to_date(&mut connection::writing(&database)?, &stimuli)).await?;
        let place = Place::of(&path)?;
        let options = SqliteConnectOptions::new().filename(&path).busy_timeout(BUSY).read_only(true);
        let reader = SqlitePoolOptions::new().max_connections(4).connect_with(options).await?;
        let readers = Readers::new(path.clone());
        let writer = Writer::start(place, move || connection::writing(&path))?;
        Ok(Store { writer, readers, reader, files, folder: folder.to_owned() })
    }
}
