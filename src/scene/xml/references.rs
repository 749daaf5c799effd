//! `id`, `<alias>` and `<ref>`: from a flat list of objects to the tree that shares them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use super::object::{Asked, Child, Class, Object, Parameter};
use crate::scene::error::{Location, SceneError, list};

/// How deep objects can be nested, references included.
pub(super) const MAX_DEPTH: usize = 64;

/// The index of a [`Draft`] in its [`Drafts`].
pub(super) type DraftIndex = usize;

/// An object whose children are not yet connected.
pub(super) struct Draft {
    pub(super) class: Class,
    pub(super) plugin: String,
    pub(super) id: Option<String>,
    pub(super) location: Location,
    pub(super) parameters: Vec<Parameter>,
    pub(super) links: Vec<Link>,
}

/// The place where an object is nested or referred to.
pub(super) struct Link {
    pub(super) name: String,
    pub(super) location: Location,
    pub(super) target: Target,
}

/// What a [`Link`] leads to.
pub(super) enum Target {
    Nested(DraftIndex),
    Id(String),
}

/// All objects of a document in the order of the files.
#[derive(Default)]
pub(super) struct Drafts {
    drafts: Vec<Draft>,
    ids: HashMap<String, DraftIndex>,
}

impl Drafts {
    /// Adds an object; an error if its id is taken.
    pub(super) fn add(&mut self, draft: Draft) -> Result<DraftIndex, SceneError> {
        let index = self.drafts.len();
        if let Some(id) = &draft.id {
            self.name(id, index, &draft.location)?;
        }
        self.drafts.push(draft);
        Ok(index)
    }

    /// Gives the object called `id`, which has to stand above, the further id `alias`.
    pub(super) fn alias(
        &mut self,
        id: &str,
        alias: &str,
        location: &Location,
    ) -> Result<(), SceneError> {
        match self.ids.get(id) {
            Some(&index) => self.name(alias, index, location),
            None => Err(SceneError::at(
                location,
                format!("no object with the id `{id}` stands above this <alias>"),
            )),
        }
    }

    fn name(&mut self, id: &str, index: DraftIndex, location: &Location) -> Result<(), SceneError> {
        if let Some(&first) = self.ids.get(id) {
            let first = &self.drafts[first].location;
            let message = format!("the id `{id}` is already that of the object at {first}");
            return Err(SceneError::at(location, message));
        }
        self.ids.insert(id.to_owned(), index);
        Ok(())
    }

    /// Adds a parameter to the object `owner`; an error if the name is taken.
    pub(super) fn add_parameter(
        &mut self,
        owner: DraftIndex,
        parameter: Parameter,
    ) -> Result<(), SceneError> {
        self.check_new_name(owner, &parameter.name, &parameter.location)?;
        self.drafts[owner].parameters.push(parameter);
        Ok(())
    }

    /// Adds a nested object or a reference to the object `owner`; an error if the name is taken.
    pub(super) fn add_link(&mut self, owner: DraftIndex, link: Link) -> Result<(), SceneError> {
        if !link.name.is_empty() {
            self.check_new_name(owner, &link.name, &link.location)?;
        }
        self.drafts[owner].links.push(link);
        Ok(())
    }

    fn check_new_name(
        &self,
        owner: DraftIndex,
        name: &str,
        location: &Location,
    ) -> Result<(), SceneError> {
        let owner = &self.drafts[owner];
        let parameters = owner.parameters.iter().map(|p| (&p.name, &p.location));
        let links = owner.links.iter().map(|link| (&link.name, &link.location));
        match parameters.chain(links).find(|(taken, _)| *taken == name) {
            Some((_, first)) => {
                let message = format!("`{name}` is given twice, first at {first}");
                Err(SceneError::at(location, message))
            }
            None => Ok(()),
        }
    }

    /// Connects everything below `root`.
    pub(super) fn connect(self, root: DraftIndex) -> Result<Arc<Object>, SceneError> {
        let Self { drafts, ids } = self;
        let location = drafts[root].location.clone();
        let mut connector = Connector {
            objects: vec![None; drafts.len()],
            drafts: drafts.into_iter().map(Some).collect(),
            ids,
            open: Vec::new(),
        };
        connector.object(root, &location)
    }
}

/// Builds objects from the leaves up, each once.
struct Connector {
    drafts: Vec<Option<Draft>>,
    objects: Vec<Option<Arc<Object>>>,
    ids: HashMap<String, DraftIndex>,
    /// The objects between the root and the one being built.
    open: Vec<Open>,
}

struct Open {
    index: DraftIndex,
    name: String,
}

impl Connector {
    /// The object `index`, wanted at `location`.
    fn object(
        &mut self,
        index: DraftIndex,
        location: &Location,
    ) -> Result<Arc<Object>, SceneError> {
        if let Some(object) = &self.objects[index] {
            return Ok(object.clone());
        }
        // A draft that is neither built nor there any more is being built: it contains itself.
        let Some(draft) = self.drafts[index].take() else {
            return Err(self.cycle(index, location));
        };
        if self.open.len() >= MAX_DEPTH {
            let message = format!("objects are nested more than {MAX_DEPTH} deep");
            return Err(SceneError::at(location, message));
        }
        self.open.push(Open {
            index,
            name: draft.id.clone().unwrap_or_else(|| draft.plugin.clone()),
        });
        let mut children = Vec::with_capacity(draft.links.len());
        for link in draft.links {
            let target = match link.target {
                Target::Nested(index) => index,
                Target::Id(id) => self.find(&id, &link.location)?,
            };
            children.push(Child {
                object: self.object(target, &link.location)?,
                name: link.name,
                location: link.location,
            });
        }
        self.open.pop();
        let object = Arc::new(Object {
            class: draft.class,
            plugin: draft.plugin,
            id: draft.id,
            location: draft.location,
            parameters: draft.parameters,
            children,
            asked: Mutex::new(Asked::default()),
        });
        self.objects[index] = Some(object.clone());
        Ok(object)
    }

    fn find(&self, id: &str, location: &Location) -> Result<DraftIndex, SceneError> {
        self.ids.get(id).copied().ok_or_else(|| {
            let mut known: Vec<&str> = self.ids.keys().map(String::as_str).collect();
            known.sort_unstable();
            let message = format!("no object has the id `{id}`; there are: {}", list(known));
            SceneError::at(location, message)
        })
    }

    fn cycle(&self, index: DraftIndex, location: &Location) -> SceneError {
        let names: Vec<&str> = self
            .open
            .iter()
            .skip_while(|open| open.index != index)
            .map(|open| open.name.as_str())
            .collect();
        let first = names.first().copied().unwrap_or_default();
        let message = format!(
            "an object contains itself: {} -> {first}",
            names.join(" -> ")
        );
        SceneError::at(location, message)
    }
}
