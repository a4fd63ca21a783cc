//! Who may read results: password hashes and signed-in browsers.

use crate::clock;
use crate::error::StoreError;
use crate::sqlite::Store;
use rusqlite::params;
use std::time::Duration;

impl Store {
    /// The researcher's password hash (PHC text); `None` for an unknown one.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn password_hash(&self, name: &str) -> Result<Option<String>, StoreError> {
        Ok(sqlx::query_scalar("SELECT password_hash FROM researchers WHERE name = $1")
            .bind(name)
            .fetch_optional(&self.reader)
            .await?)
    }

    /// Sets a researcher's password hash and signs every browser of theirs out.
    ///
    /// # Errors
    /// The database fails.
    pub async fn set_password_hash(&self, name: &str, hash: &str) -> Result<(), StoreError> {
        let [name, hash] = [name, hash].map(str::to_owned);
        self.write(move |writer| {
            writer.execute(
                "INSERT INTO researchers (name, password_hash, changed_at) VALUES (?1, ?2, ?3)
                 ON CONFLICT (name) DO UPDATE SET password_hash = excluded.password_hash, changed_at = excluded.changed_at",
                params![name, hash, clock::now()],
            )?;
            writer.execute("DELETE FROM researcher_sessions WHERE name = ?1", [name])?;
            Ok(())
        })
        .await
    }

    /// Signs a browser in for `lasting`; only the token's hash is kept.
    ///
    /// # Errors
    /// The database refuses, as it does an unknown researcher.
    pub async fn sign_in(&self, name: &str, token_hash: &str, lasting: Duration) -> Result<(), StoreError> {
        let [name, token_hash] = [name, token_hash].map(str::to_owned);
        self.write(move |writer| {
            let now = clock::now();
            writer.execute("DELETE FROM researcher_sessions WHERE expires_at <= ?1", [&now])?;
            writer.execute(
                "INSERT INTO researcher_sessions (token_hash, name, created_at, expires_at) VALUES (?1, ?2, ?3, ?4)",
                params![token_hash, name, now, clock::after_now(lasting)],
            )?;
            Ok(())
        })
        .await
    }

    /// Who is signed in with this token, if anyone still is.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn signed_in(&self, token_hash: &str) -> Result<Option<String>, StoreError> {
        Ok(sqlx::query_scalar(
            "SELECT name FROM researcher_sessions WHERE token_hash = $1 AND expires_at > $2",
        )
        .bind(token_hash)
        .bind(clock::now())
        .fetch_optional(&self.reader)
        .await?)
    }

    /// Signs the browser with this token out.
    ///
    /// # Errors
    /// The database fails.
    pub async fn sign_out(&self, token_hash: &str) -> Result<(), StoreError> {
        let token_hash = token_hash.to_owned();
        self.write(move |writer| {
            writer.execute("DELETE FROM researcher_sessions WHERE token_hash = ?1", [token_hash])?;
            Ok(())
        })
        .await
    }
}
