//! The proxies whose word is taken for where a request comes from.

use std::net::IpAddr;

/// Networks of trusted proxies; none by default, so that `X-Forwarded-For` is believed of nobody.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TrustedProxies(Vec<Network>);

/// A network: an address and how many of its leading bits count, both as of IPv6.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Network {
    address: u128,
    bits: u32,
}

impl TrustedProxies {
    /// Networks in CIDR notation (`10.0.0.0/8`, `fd00::/8`) or single addresses.
    ///
    /// # Errors
    /// A sentence about the first that is neither.
    pub fn parse<'a>(networks: impl IntoIterator<Item = &'a str>) -> Result<TrustedProxies, String> {
        let parse =
            |text: &str| {
                network(text).ok_or_else(|| {
            format!("trusted proxy {text:?}: must be an address or a network, such as 10.0.0.1 or 10.0.0.0/8")
        })
            };
        networks.into_iter().map(parse).collect::<Result<_, _>>().map(TrustedProxies)
    }

    /// Whether an address is a trusted proxy's.
    pub(crate) fn contains(&self, address: IpAddr) -> bool {
        let address = wide(address);
        self.0.iter().any(|network| (address ^ network.address).leading_zeros() >= network.bits)
    }
}

fn network(text: &str) -> Option<Network> {
    let (address, bits) = match text.trim().split_once('/') {
        Some((address, bits)) => (address, Some(bits.parse::<u32>().ok()?)),
        None => (text.trim(), None),
    };
    let address: IpAddr = address.parse().ok()?;
    let most = if address.is_ipv4() { 32 } else { 128 };
    let bits = bits.unwrap_or(most);
    (bits <= most).then(|| Network { address: wide(address), bits: 128 - most + bits })
}

/// IPv4 within IPv6, so that both are one kind of number.
fn wide(address: IpAddr) -> u128 {
    match address {
        IpAddr::V4(address) => address.to_ipv6_mapped(),
        IpAddr::V6(address) => address,
    }
    .to_bits()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn networks_hold_their_addresses_and_no_others() {
        let trusted =
            TrustedProxies::parse(["10.0.0.0/8", "192.0.2.7", "fd00::/8", "172.16.0.0/12"]).unwrap();
        let holds = |address: &str| trusted.contains(address.parse().unwrap());
        for inside in ["10.0.0.0", "10.255.255.255", "192.0.2.7", "fdff::1", "172.31.0.1", "::ffff:10.1.1.1"]
        {
            assert!(holds(inside), "{inside}");
        }
        for outside in ["11.0.0.0", "192.0.2.8", "fe00::1", "172.32.0.1", "::1", "::a00:1"] {
            assert!(!holds(outside), "{outside}");
        }
        assert!(TrustedProxies::parse(["0.0.0.0/0"]).unwrap().contains("8.8.8.8".parse().unwrap()));
        assert!(!TrustedProxies::default().contains("::1".parse().unwrap()));
        for wrong in ["", "10.0.0.0/33", "fd00::/129", "proxy", "10.0.0/8", "10.0.0.0/-1", "10.0.0.0/8/8"] {
            assert!(TrustedProxies::parse([wrong]).is_err(), "{wrong}");
        }
    }
}
