//! Signatures of WGSL functions from naga's reflection: what a function takes and gives, as the
//! flat list of 32-bit words that the evaluator moves.

use naga::{Module, ScalarKind, TypeInner};

/// A 32-bit scalar type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// f32.
    Float,
    /// u32.
    Unsigned,
    /// i32.
    Signed,
    /// bool, moved as 0 or 1.
    Bool,
}

impl Kind {
    /// The type's name in WGSL.
    pub fn wgsl(self) -> &'static str {
        match self {
            Kind::Float => "f32",
            Kind::Unsigned => "u32",
            Kind::Signed => "i32",
            Kind::Bool => "bool",
        }
    }
}

/// One word of an argument or a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component {
    /// Where it is, as a WGSL expression: `light.position.x`.
    pub path: String,
    /// Its type.
    pub kind: Kind,
}

/// A value's type as far as the evaluator needs it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A scalar.
    Scalar(Kind),
    /// A vector, matrix, array or struct: its WGSL constructor and its parts (accessor, shape).
    Composite(String, Vec<(String, Shape)>),
    /// A texture, with its WGSL type.
    Texture(String),
    /// A sampler, with its WGSL type.
    Sampler(String),
}

impl Shape {
    /// The words of the value named `path`, in order.
    pub fn components(&self, path: &str) -> Vec<Component> {
        match self {
            Shape::Scalar(kind) => vec![Component { path: path.into(), kind: *kind }],
            Shape::Composite(_, parts) => parts
                .iter()
                .flat_map(|(accessor, shape)| shape.components(&format!("{path}{accessor}")))
                .collect(),
            Shape::Texture(_) | Shape::Sampler(_) => Vec::new(),
        }
    }

    /// True for textures and samplers, which are bound rather than moved.
    pub fn is_resource(&self) -> bool {
        matches!(self, Shape::Texture(_) | Shape::Sampler(_))
    }
}

/// A function's signature.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The function's name.
    pub name: String,
    /// Arguments: name and shape.
    pub arguments: Vec<(String, Shape)>,
    /// The result's shape.
    pub result: Shape,
}

impl Signature {
    /// Reads a function's signature; `Err` says which part the evaluator cannot handle.
    pub fn of(module: &Module, function: &str) -> Result<Self, String> {
        let (_, found) = module
            .functions
            .iter()
            .find(|(_, f)| f.name.as_deref() == Some(function))
            .ok_or_else(|| format!("no function `{function}`"))?;
        let arguments = found
            .arguments
            .iter()
            .map(|argument| {
                let name = argument.name.clone().unwrap_or_default();
                let shape = shape(module, argument.ty)?;
                Ok((name, shape))
            })
            .collect::<Result<Vec<_>, String>>()?;
        let result = found.result.as_ref().ok_or("a function without a result")?;
        let result = shape(module, result.ty)?;
        if arguments.iter().all(|(name, shape)| shape.components(name).is_empty()) {
            return Err("a function without arguments to vary".into());
        }
        Ok(Self { name: function.into(), arguments, result })
    }

    /// The words of one input record.
    pub fn inputs(&self) -> Vec<Component> {
        self.arguments.iter().flat_map(|(name, shape)| shape.components(name)).collect()
    }

    /// The words of one output record.
    pub fn outputs(&self) -> Vec<Component> {
        self.result.components("")
    }

    /// True when the function takes a texture or a sampler.
    pub fn needs_resources(&self) -> bool {
        self.arguments.iter().any(|(_, shape)| shape.is_resource())
    }
}

/// Names of a vector's components.
const AXES: [&str; 4] = [".x", ".y", ".z", ".w"];

fn shape(module: &Module, ty: naga::Handle<naga::Type>) -> Result<Shape, String> {
    let found = &module.types[ty];
    let name = || found.name.clone().unwrap_or_else(|| format!("{:?}", found.inner));
    let vector = |size: naga::VectorSize, kind: Kind| {
        let size = size as usize;
        let parts = AXES[..size].iter().map(|axis| (axis.to_string(), Shape::Scalar(kind)));
        Shape::Composite(format!("vec{size}<{}>", kind.wgsl()), parts.collect())
    };
    Ok(match found.inner {
        TypeInner::Scalar(scalar) => Shape::Scalar(kind(scalar)?),
        TypeInner::Vector { size, scalar } => vector(size, kind(scalar)?),
        TypeInner::Matrix { columns, rows, scalar } => {
            let kind = kind(scalar)?;
            let columns = columns as usize;
            let parts = (0..columns).map(|c| (format!("[{c}]"), vector(rows, kind)));
            let constructor = format!("mat{columns}x{}<{}>", rows as usize, kind.wgsl());
            Shape::Composite(constructor, parts.collect())
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
            let element = shape(module, base)?;
            let parts = (0..count.get()).map(|i| (format!("[{i}]"), element.clone()));
            Shape::Composite("array".into(), parts.collect())
        }
        TypeInner::Struct { ref members, .. } => {
            let part = |member: &naga::StructMember| {
                let accessor = format!(".{}", member.name.as_deref().unwrap_or_default());
                Ok((accessor, shape(module, member.ty)?))
            };
            let parts = members.iter().map(part).collect::<Result<Vec<_>, String>>()?;
            Shape::Composite(name(), parts)
        }
        TypeInner::Image { dim: naga::ImageDimension::D2, arrayed: true, class } => match class {
            naga::ImageClass::Depth { multi: false } => {
                Shape::Texture("texture_depth_2d_array".into())
            }
            naga::ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => {
                Shape::Texture("texture_2d_array<f32>".into())
            }
            _ => return Err(format!("the texture type {}", name())),
        },
        TypeInner::Image {
            dim: naga::ImageDimension::Cube,
            arrayed: false,
            class: naga::ImageClass::Depth { multi: false },
        } => Shape::Texture("texture_depth_cube".into()),
        TypeInner::Sampler { comparison: true } => Shape::Sampler("sampler_comparison".into()),
        TypeInner::Sampler { comparison: false } => Shape::Sampler("sampler".into()),
        _ => return Err(format!("the type {}", name())),
    })
}

fn kind(scalar: naga::Scalar) -> Result<Kind, String> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => Ok(Kind::Float),
        (ScalarKind::Uint, 4) => Ok(Kind::Unsigned),
        (ScalarKind::Sint, 4) => Ok(Kind::Signed),
        (ScalarKind::Bool, _) => Ok(Kind::Bool),
        _ => Err(format!("the scalar type {scalar:?}")),
    }
}
