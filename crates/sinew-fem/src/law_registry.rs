//! Registry of the laws that scenes and [`crate::Law`] know by their ids: those of this crate, and those that a program
//! adds.

use std::fmt;
use std::sync::{Arc, PoisonError, RwLock};

use crate::hyperelastic::arruda_boyce::ArrudaBoyce;
use crate::hyperelastic::boxed::PointLaw;
use crate::hyperelastic::corotational::Corotational;
use crate::hyperelastic::fung::Fung;
use crate::hyperelastic::gent::Gent;
use crate::hyperelastic::law::{HyperelasticLaw, NodeBlock};
use crate::hyperelastic::law_error::LawError;
use crate::hyperelastic::mooney_rivlin::MooneyRivlin;
use crate::hyperelastic::neo_hookean::NeoHookean;
use crate::hyperelastic::neo_hookean_iso::NeoHookeanIso;
use crate::hyperelastic::neo_hookean_log::NeoHookeanLog;
use crate::hyperelastic::ogden::Ogden;
use crate::hyperelastic::parameters::{
    LawParameter, LawValues, ParameterError, Parameters, engineering,
};
use crate::hyperelastic::stable_neo_hookean::StableNeoHookean;
use crate::hyperelastic::stable_neo_hookean_log::StableNeoHookeanLog;
use crate::hyperelastic::stvk::Stvk;
use crate::hyperelastic::tensor::Tensor;
use crate::hyperelastic::veronda_westmann::VerondaWestmann;
use crate::hyperelastic::yeoh::Yeoh;
use crate::large::{Asked, Compiled, Own};

/// A law whose type is erased. Its loops are compiled for its own type all the same; they are chosen once per region.
#[derive(Clone, Debug)]
pub struct Hyperelastic(Arc<dyn Compiled>);

macro_rules! laws {
    ($($law:ident),+ $(,)?) => {
        impl Hyperelastic {
            /// The ids of the laws of this crate.
            pub const IDS: &'static [&'static str] = &[$($law::ID),+];
        }

        /// The laws of this crate.
        static OURS: &[KnownLaw] = &[$(KnownLaw::of::<$law>()),+];
    };
}

// A law of this crate is a file and a line here.
laws! {
    NeoHookean,
    StableNeoHookean,
    Corotational,
    Stvk,
    MooneyRivlin,
    NeoHookeanLog,
    NeoHookeanIso,
    StableNeoHookeanLog,
    Yeoh,
    Fung,
    Gent,
    ArrudaBoyce,
    VerondaWestmann,
    Ogden,
}

/// The laws that the program has added.
static ADDED: RwLock<Vec<&'static KnownLaw>> = RwLock::new(Vec::new());

/// The models that are not laws of large deformation.
const RESERVED: [&str; 2] = ["linear", "springs"];

/// The keys that a region of a scene has itself, whatever its law: no law has a parameter with one of these names.
/// Young's modulus and Poisson's ratio are parameters that laws share.
pub const KEYS_OF_REGIONS: &[&str] = &[
    "group",
    "where",
    "density",
    "model",
    "springs",
    "element",
    "edge_share",
    "patch",
    "axes",
    "fibres",
    "prony",
    "viscous_part",
    "moduli",
];

/// Adds a law, so that scenes and [`crate::Law::Hyperelastic`] know it by its id, for as long as the program runs. Its
/// loops are compiled for its own type, as those of this crate's laws are.
///
/// # Errors
///
/// [`RegisterError`] for an id that is taken, or a parameter whose name cannot be a key of a scene.
pub fn register<L: HyperelasticLaw + 'static>() -> Result<(), RegisterError> {
    add(KnownLaw::of::<L>())
}

/// A function that makes a boxed law from the values of its parameters.
pub type MakeBoxed =
    Box<dyn Fn(&LawValues<'_>) -> Result<Arc<dyn PointLaw>, ParameterError> + Send + Sync>;

/// Adds a law that is known at run time only; otherwise the same as [`register`], but much slower ([`PointLaw`]).
/// `meaning` is its use in half a sentence.
///
/// # Errors
///
/// [`RegisterError`] for an id that is taken, or a parameter whose name cannot be a key of a scene.
pub fn register_boxed(
    id: &'static str,
    meaning: &'static str,
    parameters: &'static [LawParameter],
    make: MakeBoxed,
) -> Result<(), RegisterError> {
    add(KnownLaw {
        id,
        meaning,
        parameters,
        weakness: None,
        has_isochoric_part: false,
        has_axes: false,
        make: Make::Boxed(make),
    })
}

fn add(law: KnownLaw) -> Result<(), RegisterError> {
    let id = law.id;
    let is_name = |name: &str| {
        let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
        !name.is_empty() && name.chars().all(fits)
    };
    let mut names = std::iter::once(id).chain(law.parameters.iter().map(|own| own.name));
    if let Some(name) = names.find(|name| !is_name(name)) {
        return Err(RegisterError::NotAName { id, name });
    }
    for (place, parameter) in law.parameters.iter().enumerate() {
        let key = parameter.name;
        if KEYS_OF_REGIONS.contains(&key) {
            return Err(RegisterError::KeyOfRegions { id, key });
        }
        if law.parameters[..place]
            .iter()
            .any(|other| other.name == key)
        {
            return Err(RegisterError::TwoOfAName { id, key });
        }
    }
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    let is_taken = RESERVED.contains(&law.id)
        || OURS.iter().any(|known| known.id == law.id)
        || added.iter().any(|known| known.id == law.id);
    if is_taken {
        return Err(RegisterError::Taken { id });
    }
    added.push(Box::leak(Box::new(law)));
    Ok(())
}

/// All laws that are known: those of this crate, then those added, in their order.
#[must_use]
pub fn known_laws() -> Vec<&'static KnownLaw> {
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    OURS.iter().chain(added.iter().copied()).collect()
}

/// The law with an id; `None` if absent.
#[must_use]
pub fn known_law(id: &str) -> Option<&'static KnownLaw> {
    known_laws().into_iter().find(|known| known.id == id)
}

/// A law that is known by its id.
#[derive(Debug)]
pub struct KnownLaw {
    id: &'static str,
    meaning: &'static str,
    parameters: &'static [LawParameter],
    weakness: Option<[&'static str; 2]>,
    has_isochoric_part: bool,
    has_axes: bool,
    make: Make,
}

enum Make {
    Compiled(fn(&LawValues<'_>) -> Result<Hyperelastic, ParameterError>),
    Boxed(MakeBoxed),
}

impl fmt::Debug for Make {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Compiled(_) => "compiled",
            Self::Boxed(_) => "boxed",
        })
    }
}

impl KnownLaw {
    const fn of<L: HyperelasticLaw + 'static>() -> Self {
        Self {
            id: L::ID,
            meaning: L::MEANING,
            parameters: L::PARAMETERS,
            weakness: L::WEAKNESS,
            has_isochoric_part: L::HAS_ISOCHORIC_PART,
            has_axes: L::HAS_AXES,
            make: Make::Compiled(|values| Ok(Hyperelastic::of(L::from_values(values)?))),
        }
    }

    /// Name in scenes.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.id
    }

    /// Use of the law in half a sentence.
    #[must_use]
    pub fn meaning(&self) -> &'static str {
        self.meaning
    }

    /// Its parameters.
    #[must_use]
    pub fn parameters(&self) -> &'static [LawParameter] {
        self.parameters
    }

    /// Warning for scenes with the law, and advice.
    #[must_use]
    pub fn weakness(&self) -> Option<[&'static str; 2]> {
        self.weakness
    }

    /// True if its isochoric part can relax alone.
    #[must_use]
    pub fn has_isochoric_part(&self) -> bool {
        self.has_isochoric_part
    }

    /// True if the material has axes, which a region then states.
    #[must_use]
    pub fn has_axes(&self) -> bool {
        self.has_axes
    }

    /// The law with these parameters.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a parameter that is missing, outside its range or another law's, or for values that do
    /// not fit together.
    pub fn make(&self, parameters: &Parameters) -> Result<Hyperelastic, ParameterError> {
        let values = parameters.checked(self.id, self.parameters)?;
        match &self.make {
            Make::Compiled(make) => make(&values),
            Make::Boxed(make) => Ok(Hyperelastic(Arc::new(make(&values)?))),
        }
    }

    /// Example values of the parameters, but with this Young's modulus (Pa) and Poisson's ratio at small strain: all
    /// moduli are multiplied by the same factor.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a law that cannot have them.
    pub fn with_moduli(
        &self,
        youngs_modulus: f64,
        poissons_ratio: f64,
    ) -> Result<Parameters, ParameterError> {
        let mut parameters = Parameters::examples(self.parameters);
        let given = |parameters: &Parameters, parameter: &LawParameter| {
            parameters.get(parameter.name).is_some()
        };
        let is_stated = given(&parameters, &LawParameter::YOUNGS_MODULUS);
        if !is_stated {
            let (_, mu) = self.make(&parameters)?.lame();
            let wanted = 0.5 * youngs_modulus / (1.0 + poissons_ratio);
            parameters.scale(self.parameters, wanted / mu, true);
        }
        let bulk = youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio));
        for (parameter, value) in [
            (LawParameter::YOUNGS_MODULUS, youngs_modulus),
            (LawParameter::POISSONS_RATIO, poissons_ratio),
            (LawParameter::BULK_MODULUS, bulk),
        ] {
            if given(&parameters, &parameter) {
                parameters.set(parameter.name, &[value]);
            }
        }
        self.make(&parameters).map(|_| parameters)
    }
}

impl Hyperelastic {
    /// A law of a known type.
    #[must_use]
    pub fn of<L: HyperelasticLaw + 'static>(law: L) -> Self {
        Self(Arc::new(Own(law)))
    }

    /// The law with an id and these parameters.
    ///
    /// # Errors
    ///
    /// [`LawError`] if there is no such law, or if it cannot have these parameters.
    pub fn new(id: &str, parameters: &Parameters) -> Result<Self, LawError> {
        Ok(found(id)?.make(parameters)?)
    }

    /// Example parameters of the law with an id, with this Young's modulus (Pa) and Poisson's ratio at small strain
    /// ([`KnownLaw::with_moduli`]).
    ///
    /// # Errors
    ///
    /// [`LawError`] if there is no such law, or if it cannot have them.
    pub fn parameters(
        id: &str,
        youngs_modulus: f64,
        poissons_ratio: f64,
    ) -> Result<Parameters, LawError> {
        Ok(found(id)?.with_moduli(youngs_modulus, poissons_ratio)?)
    }

    /// Name in scenes.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.0.id()
    }

    /// Lame's constants (lambda, mu) (Pa) at small strain.
    #[must_use]
    pub fn lame(&self) -> (f64, f64) {
        self.0.lame()
    }

    /// Young's modulus (Pa) and Poisson's ratio at small strain.
    #[must_use]
    pub fn engineering_constants(&self) -> [f64; 2] {
        engineering(self.lame())
    }

    /// True if the law is defined for inverted elements.
    #[must_use]
    pub fn is_defined_when_inverted(&self) -> bool {
        self.0.is_defined_when_inverted()
    }

    /// True if it is defined at a gradient of the displacement.
    #[must_use]
    pub fn is_defined_at(&self, h: Tensor<f64>) -> bool {
        self.asked().at(h, false, |at| at.admits())
    }

    /// True if its isochoric part can relax alone.
    #[must_use]
    pub fn has_isochoric_part(&self) -> bool {
        self.0.has_isochoric_part()
    }

    /// True if the material has axes; stresses and tangents here are those in the axes of coordinates.
    #[must_use]
    pub fn has_axes(&self) -> bool {
        self.0.has_axes()
    }

    /// The least and the largest shear modulus (Pa) at small strain.
    #[must_use]
    pub fn shear_moduli(&self) -> [f64; 2] {
        self.0.shear_moduli()
    }

    /// The tangent from which the nodes' own blocks are computed.
    #[must_use]
    pub fn node_block_kind(&self) -> NodeBlock {
        self.0.node_block_kind()
    }

    /// Energy density (J/m^3) of a tetrahedron without averages, from the gradient of the displacement.
    #[must_use]
    pub fn energy(&self, h: Tensor<f64>) -> f64 {
        self.asked().at(h, f64::NAN, |at| at.whole_energy())
    }

    /// First Piola-Kirchhoff stress (Pa) of a tetrahedron without averages, from the gradient of the displacement.
    #[must_use]
    pub fn stress(&self, h: Tensor<f64>) -> Tensor<f64> {
        self.asked().at(h, Tensor::zero(), |at| {
            at.stress()
                .plus(at.own_bulk().stress, at.dilation_gradient())
        })
    }

    /// Change of [`Self::stress`] by a change of F.
    #[must_use]
    pub fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64> {
        self.asked().at(h, Tensor::zero(), |at| {
            at.tangent_with(at.own_bulk(), change)
        })
    }

    /// A node's own block (Pa/m^2) of a tetrahedron without averages, from the gradient (1/m) of its shape function
    /// ([`HyperelasticLaw::node_block`]).
    #[must_use]
    pub fn node_block(&self, h: Tensor<f64>, gradient: [f64; 3]) -> Tensor<f64> {
        self.asked().at(h, Tensor::zero(), |at| {
            at.node_block(at.own_bulk(), gradient)
        })
    }

    /// [`crate::hyperelastic::sample_deformations`] of the law.
    #[must_use]
    pub fn samples(&self) -> Vec<[Tensor<f64>; 2]> {
        self.0.samples()
    }

    fn asked(&self) -> &dyn Asked {
        &*self.0
    }

    /// Its loops.
    pub(crate) fn compiled(&self) -> Arc<dyn Compiled> {
        Arc::clone(&self.0)
    }
}

impl fmt::Display for Hyperelastic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

fn found(id: &str) -> Result<&'static KnownLaw, LawError> {
    known_law(id).ok_or_else(|| LawError::Unknown {
        id: id.to_owned(),
        known: known_laws().iter().map(|known| known.id).collect(),
    })
}

/// A law that cannot be added.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RegisterError {
    /// An id that another model has.
    #[error("the id `{id}` is used by another model: choose another id for the law")]
    Taken {
        /// The id.
        id: &'static str,
    },
    /// A parameter with the name of a key that regions of scenes have themselves.
    #[error(
        "the law `{id}` has a parameter `{key}`, which is a key of every region in a scene: give the parameter another name"
    )]
    KeyOfRegions {
        /// The law's id.
        id: &'static str,
        /// The parameter.
        key: &'static str,
    },
    /// An id, or the name of a parameter, that cannot be a word of a scene.
    #[error(
        "the law {id:?} has the name {name:?}: expected letters, digits, `-` and `_` in its id and in the names of its parameters"
    )]
    NotAName {
        /// The law's id.
        id: &'static str,
        /// The name.
        name: &'static str,
    },
    /// Two parameters with the same name.
    #[error("the law `{id}` has two parameters `{key}`: give one of them another name")]
    TwoOfAName {
        /// The law's id.
        id: &'static str,
        /// The name.
        key: &'static str,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_is_found_by_its_id_and_has_the_moduli_asked_for() {
        for &id in Hyperelastic::IDS {
            let parameters = Hyperelastic::parameters(id, 3500.0, 0.45).unwrap();
            let law = Hyperelastic::new(id, &parameters).unwrap();
            assert_eq!(law.to_string(), id);
            let (lambda, mu) = law.lame();
            let (expected_lambda, expected_mu) = crate::tetra::lame(3500.0, 0.45);
            assert!((lambda / expected_lambda - 1.0).abs() < 1e-14, "{id}");
            assert!((mu / expected_mu - 1.0).abs() < 1e-14, "{id}");
            let [modulus, ratio] = law.engineering_constants();
            assert!((modulus / 3500.0 - 1.0).abs() < 1e-14, "{id}");
            assert!((ratio / 0.45 - 1.0).abs() < 1e-14, "{id}");
        }
    }

    #[test]
    fn every_law_stands_the_suite() {
        for &id in Hyperelastic::IDS {
            for poissons_ratio in [0.0, 0.3, 0.45] {
                let parameters = Hyperelastic::parameters(id, 3500.0, poissons_ratio).unwrap();
                let law = Hyperelastic::new(id, &parameters).unwrap();
                law.0.check_conformance();
            }
        }
    }

    #[test]
    fn every_parameter_is_given_an_example_that_fits() {
        for law in OURS {
            let parameters = Parameters::examples(law.parameters);
            law.make(&parameters).unwrap();
            for parameter in law.parameters {
                let (least, most) = parameter.list.unwrap_or((1, 1));
                let width = parameter.width();
                let lengths = least * width..=most * width;
                assert!(lengths.contains(&parameter.example.len()));
                let mut example = parameter.example.iter().enumerate();
                assert!(example.all(|(place, value)| parameter.range_at(place).contains(*value)));
                assert!(parameter.meaning.ends_with('.'), "{}", parameter.name);
            }
        }
    }

    #[test]
    fn an_id_is_given_once() {
        let taken = register::<NeoHookean>().unwrap_err().to_string();
        assert!(taken.starts_with("the id `neo-hookean` is used"), "{taken}");
        let make = || -> MakeBoxed { Box::new(|_| Err(ParameterError::NotStated { law: "none" })) };
        assert!(register_boxed("linear", "", &[], make()).is_err());
        register_boxed("registered-once", "", &[], make()).unwrap();
        assert!(register_boxed("registered-once", "", &[], make()).is_err());
        assert_eq!(
            known_law("registered-once").unwrap().id(),
            "registered-once"
        );
    }

    #[test]
    fn a_parameter_that_could_be_no_key_of_a_scene_is_refused() {
        static OF_REGIONS: [LawParameter; 1] = [LawParameter {
            name: "density",
            ..LawParameter::BULK_MODULUS
        }];
        static TWICE: [LawParameter; 2] = [LawParameter::BULK_MODULUS; 2];
        let make = || -> MakeBoxed { Box::new(|_| Err(ParameterError::NotStated { law: "none" })) };
        let said = |id, parameters| {
            let refused = register_boxed(id, "", parameters, make()).unwrap_err();
            assert!(known_law(id).is_none());
            refused.to_string()
        };
        let expected = "the law `heavy` has a parameter `density`, which is a key of every region in a scene: give the parameter another name";
        assert_eq!(said("heavy", &OF_REGIONS), expected);
        let expected =
            "the law `double` has two parameters `bulk_modulus`: give one of them another name";
        assert_eq!(said("double", &TWICE), expected);
        static UNNAMED: [LawParameter; 1] = [LawParameter {
            name: "",
            ..LawParameter::BULK_MODULUS
        }];
        let expected = "the law \"bare\" has the name \"\": expected letters";
        assert!(said("bare", &UNNAMED).starts_with(expected));
        for id in ["", "two words", "line\nend", "\"quoted\""] {
            assert!(said(id, &[]).starts_with(&format!("the law {id:?} has the name {id:?}")));
        }
        for law in OURS {
            let mut names = law.parameters.iter().map(|parameter| parameter.name);
            assert!(
                names.all(|name| !KEYS_OF_REGIONS.contains(&name)),
                "{}",
                law.id
            );
        }
    }

    #[test]
    fn parameters_that_a_law_cannot_have_are_refused_by_name() {
        let said = |id: &str, parameters: &Parameters| {
            Hyperelastic::new(id, parameters).unwrap_err().to_string()
        };
        let good = Parameters::new(1.0, 0.3);
        assert!(
            said("rubber", &good).starts_with("no law is called `rubber`; there are neo-hookean,")
        );
        for law in OURS {
            let parameters = law.with_moduli(1.0, 0.3).unwrap();
            for parameter in law.parameters {
                let mut less = parameters.clone();
                less.remove(parameter.name);
                // One of several that is left out already.
                if less == parameters {
                    continue;
                }
                let needed = said(law.id, &less);
                let expected = format!("the law `{}` needs", law.id);
                assert!(needed.starts_with(&expected), "{needed}");
                assert!(needed.contains(parameter.name), "{needed}");
                let not_numbers = vec![f64::NAN; parameter.example.len()];
                let wrong = parameters.clone().with(parameter.name, &not_numbers);
                let said = said(law.id, &wrong);
                assert!(
                    said.starts_with(&format!("{} = NaN: expected", parameter.name)),
                    "{said}"
                );
            }
            let foreign = parameters.clone().with("c1_over_c3", &[1.0]);
            let expected = format!("the law `{}` has no c1_over_c3", law.id);
            assert_eq!(said(law.id, &foreign), expected);
        }
        for nu in [-0.1, 0.5, f64::NAN] {
            let said = said("stvk", &Parameters::new(1.0, nu));
            assert!(said.starts_with("poissons_ratio = "), "{said}");
        }
        for modulus in [0.0, -1.0, f64::INFINITY] {
            let said = said("corotational", &Parameters::new(modulus, 0.3));
            assert!(said.starts_with("youngs_modulus = "), "{said}");
        }
    }
}
