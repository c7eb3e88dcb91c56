//! Ways to store, as users write them.

use super::Storage;
use std::fmt;
use std::str::FromStr;

const FORM: &str = "write full, bytes, pca:K, vq:N or cpca:N:K, such as cpca:64:4";

impl fmt::Display for Storage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Bytes => f.write_str("bytes"),
            Self::Components { vectors } => write!(f, "pca:{vectors}"),
            Self::Quantised { clusters } => write!(f, "vq:{clusters}"),
            Self::Clustered { clusters, vectors } => write!(f, "cpca:{clusters}:{vectors}"),
        }
    }
}

impl FromStr for Storage {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split(':').collect();
        Ok(match words[..] {
            ["full"] => Self::Full,
            ["bytes"] => Self::Bytes,
            ["pca", k] => Self::Components { vectors: number(k, 300)? },
            ["vq", n] => Self::Quantised { clusters: number(n, 4096)? },
            ["cpca", n, k] => Self::Clustered { clusters: number(n, 4096)?, vectors: number(k, 300)? },
            _ => return Err(FORM.into()),
        })
    }
}

fn number(text: &str, most: usize) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| (1..=most).contains(n));
    number.ok_or_else(|| format!("`{text}` is no number from 1 to {most}; {FORM}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_and_written_alike() {
        for text in ["full", "bytes", "pca:4", "vq:256", "cpca:64:4"] {
            assert_eq!(text.parse::<Storage>().unwrap().to_string(), text);
        }
        for wrong in ["", "pca", "pca:0", "vq:5000", "cpca:64", "cpca:64:301", "cpca:64:-1", "full:1"] {
            assert!(wrong.parse::<Storage>().unwrap_err().contains("cpca:64:4"), "{wrong}");
        }
    }
}
