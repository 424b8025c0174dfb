//! The modules of a crate and the files that their paths lead to.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenTree};

use super::breach::RuleError;
use super::code::{
    self, Import, group, ident, imports, is_path_separator, is_punct, path, path_attribute,
};
use super::components::Edges;
use super::files::source;

/// Longest chain of imports that is followed. Circular imports end here.
const DEEPEST: usize = 32;

/// All modules that are reached from the root file of a crate.
pub(super) struct Modules {
    all: Vec<Module>,
    /// Modules that define a macro with `#[macro_export]`, which makes it a member of the crate's root.
    macros: BTreeMap<String, usize>,
}

/// A module, in its own file or in braces.
struct Module {
    file: PathBuf,
    parent: Option<usize>,
    /// Several modules have one name if `cfg` chooses between files.
    children: BTreeMap<String, Vec<usize>>,
    /// Names of the items defined here.
    items: BTreeSet<String>,
    imports: Vec<Import>,
    /// Paths in code outside imports, including single names.
    paths: BTreeSet<Vec<String>>,
}

/// True if the identifier at `at` belongs to the tokens before it: `value.name`, `Type::<T>::name`.
fn is_member(tokens: &[TokenTree], at: usize) -> bool {
    let is_dot = |back: usize| at >= back && is_punct(tokens.get(at - back), '.');
    let is_range = is_dot(1) && is_dot(2);
    is_dot(1) && !is_range || at >= 2 && is_path_separator(tokens, at - 2)
}

/// The target of a path.
#[derive(Clone, Copy)]
enum Target {
    Module(usize),
    /// Something that is defined in this module.
    Item(usize),
}

impl Modules {
    /// Reads the file `root` of a crate and all files that it names as modules.
    pub(super) fn read(root: &Path) -> Result<Self, RuleError> {
        let mut modules = Self {
            all: Vec::new(),
            macros: BTreeMap::new(),
        };
        let folder = root.parent().unwrap_or(root);
        modules.file(root, folder, None)?;
        Ok(modules)
    }

    /// Adds the module in a file, whose submodules are searched in `folder`.
    fn file(
        &mut self,
        file: &Path,
        folder: &Path,
        parent: Option<usize>,
    ) -> Result<usize, RuleError> {
        let text = source(file)?;
        let tokens = code::code(&text).map_err(|error| RuleError::NotRust {
            path: file.to_owned(),
            reason: error.to_string(),
        })?;
        self.module(file, folder, parent, &tokens)
    }

    fn module(
        &mut self,
        file: &Path,
        folder: &Path,
        parent: Option<usize>,
        tokens: &[TokenTree],
    ) -> Result<usize, RuleError> {
        let index = self.all.len();
        self.all.push(Module {
            file: file.to_owned(),
            parent,
            children: BTreeMap::new(),
            items: BTreeSet::new(),
            imports: Vec::new(),
            paths: BTreeSet::new(),
        });
        self.scan(index, folder, tokens, true)?;
        Ok(index)
    }

    /// Reads the tokens of a module, or of a group in it.
    fn scan(
        &mut self,
        module: usize,
        folder: &Path,
        tokens: &[TokenTree],
        is_top: bool,
    ) -> Result<(), RuleError> {
        let mut own_path = None;
        let mut at = 0;
        while at < tokens.len() {
            let attribute = group(tokens.get(at + 1), Delimiter::Bracket);
            if let Some(attribute) = attribute.filter(|_| is_punct(tokens.get(at), '#')) {
                own_path = path_attribute(attribute);
                at += 2;
                continue;
            }
            if let TokenTree::Group(group) = &tokens[at] {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                self.scan(module, folder, &inner, false)?;
                at += 1;
                continue;
            }
            let is_lifetime = at > 0 && is_punct(tokens.get(at - 1), '\'');
            let Some(word) = ident(tokens.get(at)).filter(|_| !is_lifetime) else {
                at += 1;
                continue;
            };
            let name = ident(tokens.get(at + 1));
            match (word.as_str(), name) {
                ("use", name) if name.is_some() || is_punct(tokens.get(at + 1), ':') => {
                    let (found, end) = imports(tokens, at);
                    self.all[module].imports.extend(found);
                    at = end;
                }
                ("mod", Some(name)) => {
                    let own_path = own_path.take();
                    let braces = group(tokens.get(at + 2), Delimiter::Brace);
                    let child = if let Some(braces) = braces {
                        let inner: Vec<TokenTree> = braces.stream().into_iter().collect();
                        let file = self.all[module].file.clone();
                        self.module(&file, &folder.join(&name), Some(module), &inner)?
                    } else {
                        let (file, folder) = self.place(module, folder, &name, own_path);
                        self.file(&file, &folder, Some(module))?
                    };
                    self.all[module]
                        .children
                        .entry(name)
                        .or_default()
                        .push(child);
                    at += 3;
                }
                ("macro_rules", None) if is_punct(tokens.get(at + 1), '!') => {
                    if let Some(name) = ident(tokens.get(at + 2)) {
                        self.macros.entry(name.clone()).or_insert(module);
                        self.all[module].items.insert(name);
                    }
                    at += 3;
                }
                ("const" | "static", Some(next)) if next == "fn" || next == "mut" => at += 1,
                (
                    "fn" | "struct" | "enum" | "union" | "trait" | "type" | "const" | "static",
                    Some(name),
                ) => {
                    if is_top {
                        self.all[module].items.insert(name);
                    }
                    at += 2;
                }
                _ => {
                    let (segments, end) = path(tokens, at);
                    let is_member = is_member(tokens, at);
                    let is_field = segments.len() == 1
                        && is_punct(tokens.get(end), ':')
                        && !is_path_separator(tokens, end);
                    if !is_member && !is_field {
                        self.all[module].paths.insert(segments);
                    }
                    at = end;
                }
            }
        }
        Ok(())
    }

    /// The file of the module `name` and the folder of its submodules.
    fn place(
        &self,
        parent: usize,
        folder: &Path,
        name: &str,
        own_path: Option<String>,
    ) -> (PathBuf, PathBuf) {
        if let Some(own_path) = own_path {
            let here = self.all[parent].file.parent().unwrap_or(folder);
            let file = here.join(own_path);
            let folder = file.parent().unwrap_or(here).to_owned();
            return (file, folder);
        }
        let inner = folder.join(name);
        let nested = inner.join("mod.rs");
        if nested.exists() {
            (nested, inner)
        } else {
            (folder.join(format!("{name}.rs")), inner)
        }
    }

    /// Other files of the crate whose names the code of each file uses.
    ///
    /// A re-export counts only if the code of the same module uses the name as well.
    pub(super) fn imports_of_files(&self) -> Edges<PathBuf> {
        let mut edges = Edges::new();
        for (index, module) in self.all.iter().enumerate() {
            let imports = module.imports.iter();
            let imports = imports.filter(|import| !import.is_public && import.name.is_some());
            let paths = imports.map(|import| &import.path).chain(&module.paths);
            for path in paths {
                let Some(Target::Item(other)) = self.resolve(index, path, 0) else {
                    continue;
                };
                let other = &self.all[other].file;
                if *other != module.file {
                    let files: &mut BTreeSet<PathBuf> =
                        edges.entry(module.file.clone()).or_default();
                    files.insert(other.clone());
                }
            }
        }
        edges
    }

    /// The target, within the crate, of a path in the code of the module `from`.
    fn resolve(&self, from: usize, path: &[String], depth: usize) -> Option<Target> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.walk(0, rest, depth),
            "self" if rest.is_empty() => None,
            "self" => self.walk(from, rest, depth),
            "super" => self.walk(self.all[from].parent?, rest, depth),
            name => self.member(from, name, rest, depth),
        }
    }

    fn walk(&self, at: usize, path: &[String], depth: usize) -> Option<Target> {
        let Some((first, rest)) = path.split_first() else {
            return Some(Target::Module(at));
        };
        match first.as_str() {
            "self" => self.walk(at, rest, depth),
            "super" => self.walk(self.all[at].parent?, rest, depth),
            name => {
                let exported = (at == 0).then(|| self.macros.get(name)).flatten();
                let member = self.member(at, name, rest, depth);
                // A name that is not found, made by a macro for example, is taken to be defined here.
                member.or(Some(Target::Item(exported.copied().unwrap_or(at))))
            }
        }
    }

    /// The target of `name::rest`, looked up among the names of the module `at`.
    fn member(&self, at: usize, name: &str, rest: &[String], depth: usize) -> Option<Target> {
        if depth > DEEPEST {
            return None;
        }
        let module = &self.all[at];
        // A function may have the name of a module; a path that goes on is that of the module.
        if let Some(children) = module.children.get(name)
            && let Some(next) = rest.first()
        {
            let has_next = |child: &&usize| self.has(**child, next);
            let child = children.iter().find(has_next).or(children.first())?;
            return self.walk(*child, rest, depth + 1);
        }
        if module.items.contains(name) {
            return Some(Target::Item(at));
        }
        let mut found = None;
        for import in &module.imports {
            let target = match &import.name {
                Some(own) if own == name => self.resolve(at, &import.path, depth + 1),
                Some(_) => continue,
                None => match self.resolve(at, &import.path, depth + 1) {
                    Some(Target::Module(other)) if other != at => {
                        self.member(other, name, &[], depth + 1)
                    }
                    _ => None,
                },
            };
            found = found.or(target);
        }
        let child = module
            .children
            .get(name)
            .and_then(|children| children.first());
        match found.or(child.copied().map(Target::Module))? {
            Target::Module(module) if !rest.is_empty() => self.walk(module, rest, depth + 1),
            target => Some(target),
        }
    }

    fn has(&self, module: usize, name: &str) -> bool {
        let module = &self.all[module];
        let imported = |import: &Import| import.name.as_deref() == Some(name);
        module.items.contains(name)
            || module.children.contains_key(name)
            || module.imports.iter().any(imported)
    }
}
