//! What a session's page is told and given of its stimuli: addresses and bytes of its own, that do not say which condition is which.
//!
//! Each stimulus goes out packed, filled up to the length of the longest of its trial at its size, with a last few bytes that are the session's: so its
//! hash is the session's too. Its address is a capability: who knows it may have it, and it is made from the session's secret.

use crate::api::{Problem, StimulusRef};
use crate::content::ByteCache;
use axum::body::Bytes;
use hmac::{Hmac, KeyInit, Mac};
use kelir_house::TAIL;
use kelir_store::{Packing, PlannedTrial, Session, StimulusHashes, Store, sha256_hex};
use kelir_study::trials::Role;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};
use std::iter;
use std::sync::{Mutex, PoisonError, RwLock};

/// Most bytes of stimuli that are held in memory.
const MOST_BYTES: usize = 64 << 20;
/// Most addresses that are held in memory; one that is not is found again from its session.
const MOST_ADDRESSES: usize = 200_000;

/// The session, or the preview, that is told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Whose<'a> {
    pub(crate) session_id: &'a str,
    /// Hash of its secret, from which what is its own is made.
    pub(crate) token_hash: &'a str,
}

impl<'a> Whose<'a> {
    pub(crate) fn of(session: &'a Session) -> Whose<'a> {
        Whose { session_id: &session.session_id, token_hash: &session.token_hash }
    }
}

/// A stimulus as one session gets it.
#[derive(Clone, Debug)]
pub(crate) struct Presented {
    /// The stored stimulus.
    stimulus: String,
    /// Bytes in all.
    length: u64,
    tail: [u8; TAIL],
}

pub(crate) struct Presenter {
    cache: Mutex<ByteCache>,
    packings: RwLock<HashMap<String, Packing>>,
    /// Hash of everything but the tail, by stimulus and length, to go on from.
    begun: RwLock<HashMap<(String, u64), Sha256>>,
    addresses: RwLock<HashMap<String, Presented>>,
}

impl Default for Presenter {
    fn default() -> Presenter {
        Presenter {
            cache: Mutex::new(ByteCache::new(MOST_BYTES)),
            packings: RwLock::default(),
            begun: RwLock::default(),
            addresses: RwLock::default(),
        }
    }
}

impl Presenter {
    /// What a page is told of a trial's stimuli, at each size of the study.
    pub(crate) async fn tell(
        &self,
        store: &Store,
        whose: Whose<'_>,
        trial: &PlannedTrial,
    ) -> Result<Vec<BTreeMap<Role, StimulusRef>>, Box<Problem>> {
        let mut told = Vec::with_capacity(1 + trial.larger.len());
        for stimuli in iter::once(&trial.stimuli).chain(trial.larger.iter().map(|larger| &larger.stimuli)) {
            told.push(self.tell_of_size(store, whose, stimuli).await?);
        }
        Ok(told)
    }

    async fn tell_of_size(
        &self,
        store: &Store,
        whose: Whose<'_>,
        stimuli: &BTreeMap<Role, StimulusHashes>,
    ) -> Result<BTreeMap<Role, StimulusRef>, Box<Problem>> {
        let mut longest = 0;
        for hashes in stimuli.values() {
            longest = longest.max(self.packing(store, &hashes.sha256).await?.size_bytes);
        }
        let length = longest + TAIL as u64;
        let mut told = BTreeMap::new();
        for (role, hashes) in stimuli {
            let stimulus = hashes.sha256.clone();
            let mut hash = self.begun(store, &stimulus, length).await?;
            let tail = secret(whose, "tail", &stimulus, length)?;
            hash.update(tail);
            let address = hex::encode(&secret(whose, "address", &stimulus, length)?[..16]);
            let url = address_of(whose.session_id, &address);
            self.remember(url.clone(), Presented { stimulus, length, tail });
            told.insert(*role, StimulusRef { sha256: hex::encode(hash.finalize()), url });
        }
        Ok(told)
    }

    /// What an address of a session leads to; `None` for one that it never was told.
    pub(crate) async fn find(
        &self,
        store: &Store,
        session_id: &str,
        address: &str,
    ) -> Result<Option<Presented>, Box<Problem>> {
        let url = address_of(session_id, address);
        if let Some(found) = self.known(&url) {
            return Ok(Some(found));
        }
        let Some(session) = store.session(session_id).await? else { return Ok(None) };
        for trial in store.trials(session_id).await? {
            self.tell(store, Whose::of(&session), &trial).await?;
            if let Some(found) = self.known(&url) {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// Its bytes, in parts.
    pub(crate) async fn bytes(
        &self,
        store: &Store,
        presented: &Presented,
    ) -> Result<Vec<Bytes>, Box<Problem>> {
        let common = self.filled(store, &presented.stimulus, presented.length).await?;
        Ok(vec![common, Bytes::copy_from_slice(&presented.tail)])
    }

    /// The bytes of a stored file, from memory where they are there, else held to their hash.
    pub(crate) async fn stored(&self, store: &Store, sha256: &str) -> Result<Option<Bytes>, Box<Problem>> {
        if let Some(bytes) = self.cached(sha256) {
            return Ok(Some(bytes));
        }
        let Some((_, bytes)) = store.stimulus(sha256).await? else { return Ok(None) };
        let bytes = Bytes::from(bytes);
        self.keep(sha256.to_owned(), bytes.clone());
        Ok(Some(bytes))
    }

    async fn packing(&self, store: &Store, stimulus: &str) -> Result<Packing, Box<Problem>> {
        if let Some(known) = self.packings.read().unwrap_or_else(PoisonError::into_inner).get(stimulus) {
            return Ok(known.clone());
        }
        let made = store.packing(stimulus).await?;
        let made = made.ok_or_else(|| Problem::internal(format!("stimulus {stimulus} is not stored")))?;
        self.packings
            .write()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(stimulus.to_owned(), made.clone());
        Ok(made)
    }

    /// A packed stimulus filled up to `length` without the tail. It is held to its hash whenever it is read from disk.
    async fn filled(&self, store: &Store, stimulus: &str, length: u64) -> Result<Bytes, Box<Problem>> {
        let name = format!("{stimulus} {length}");
        if let Some(bytes) = self.cached(&name) {
            return Ok(bytes);
        }
        let packing = self.packing(store, stimulus).await?;
        let damaged = || Problem::internal(format!("the packing of stimulus {stimulus} is gone or damaged"));
        let mut bytes = store.file(&packing.packed_sha256).await?.unwrap_or_default();
        if sha256_hex(&bytes) != packing.packed_sha256 {
            self.packings.write().unwrap_or_else(PoisonError::into_inner).remove(stimulus);
            store.forget_packing(stimulus).await?;
            let again = self.packing(store, stimulus).await?;
            bytes = store.file(&again.packed_sha256).await?.ok_or_else(damaged)?;
        }
        let filled =
            usize::try_from(length).map_err(Problem::internal)?.checked_sub(TAIL).ok_or_else(damaged)?;
        bytes.resize(filled, 0);
        let bytes = Bytes::from(bytes);
        self.keep(name, bytes.clone());
        Ok(bytes)
    }

    async fn begun(&self, store: &Store, stimulus: &str, length: u64) -> Result<Sha256, Box<Problem>> {
        let key = (stimulus.to_owned(), length);
        if let Some(begun) = self.begun.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Ok(begun.clone());
        }
        let mut begun = Sha256::new();
        begun.update(self.filled(store, stimulus, length).await?);
        self.begun.write().unwrap_or_else(PoisonError::into_inner).insert(key, begun.clone());
        Ok(begun)
    }

    fn known(&self, url: &str) -> Option<Presented> {
        self.addresses.read().unwrap_or_else(PoisonError::into_inner).get(url).cloned()
    }

    fn remember(&self, url: String, presented: Presented) {
        let mut addresses = self.addresses.write().unwrap_or_else(PoisonError::into_inner);
        if addresses.len() >= MOST_ADDRESSES {
            addresses.clear();
        }
        addresses.insert(url, presented);
    }

    fn cached(&self, name: &str) -> Option<Bytes> {
        self.cache.lock().unwrap_or_else(PoisonError::into_inner).get(name)
    }

    fn keep(&self, name: String, bytes: Bytes) {
        self.cache.lock().unwrap_or_else(PoisonError::into_inner).put(name, bytes);
    }
}

fn address_of(session_id: &str, address: &str) -> String {
    format!("/api/v1/sessions/{session_id}/stimuli/{address}")
}

/// A value that only who knows the session's secret can tell; the same each time.
fn secret(whose: Whose<'_>, what: &str, stimulus: &str, length: u64) -> Result<[u8; TAIL], Box<Problem>> {
    let mac = Hmac::<Sha256>::new_from_slice(whose.token_hash.as_bytes()).map_err(Problem::internal)?;
    let mac = mac.chain_update(format!("kelir-stimulus/1\n{what}\n{stimulus}\n{length}"));
    Ok(mac.finalize().into_bytes().into())
}
