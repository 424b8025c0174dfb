//! The blocks of a page: files to save, and commands.

/// A page's blocks in their order.
pub(super) struct Page<'a> {
    pub(super) blocks: Vec<Block<'a>>,
}

#[derive(Debug, PartialEq)]
pub(super) enum Block<'a> {
    /// A text to be saved under the name in its first line, a comment.
    File { name: &'a str, text: &'a str },
    /// Lines for a shell.
    Commands(Vec<&'a str>),
}

impl<'a> Page<'a> {
    /// The blocks of a page; the error names a block that cannot be run.
    pub(super) fn of(text: &'a str) -> Result<Self, String> {
        let mut blocks = Vec::new();
        let mut rest = text;
        while let Some((_, after)) = rest.split_once("\n```") {
            let (language, after) = after.split_once('\n').unwrap_or((after, ""));
            let (block, after) = after
                .split_once("\n```")
                .ok_or_else(|| format!("a block of {language:?} does not end"))?;
            blocks.push(match language {
                "sh" => Block::Commands(block.lines().collect()),
                "python" | "toml" => {
                    let first = block.lines().next().unwrap_or_default();
                    let name = first.strip_prefix("# ").ok_or_else(|| {
                        format!("expected `# NAME` in the first line of a file, not {first:?}")
                    })?;
                    Block::File { name, text: block }
                }
                other => return Err(format!("nothing tries blocks of {other:?}")),
            });
            rest = after;
        }
        Ok(Self { blocks })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_a_name_and_commands_are_lines() {
        let text = "a\n\n```python\n# a.py\nprint(1)\n```\n\n```sh\npython3 a.py\nls\n```\nb";
        let expected = [
            Block::File {
                name: "a.py",
                text: "# a.py\nprint(1)",
            },
            Block::Commands(vec!["python3 a.py", "ls"]),
        ];
        assert_eq!(Page::of(text).unwrap().blocks, expected);
    }

    #[test]
    fn what_cannot_be_tried_is_refused() {
        for text in [
            "\n```python\nprint(1)\n```\n",
            "\n```c\nx\n```\n",
            "\n```sh\nls\n",
        ] {
            assert!(Page::of(text).is_err(), "{text}");
        }
    }
}
