//! Rules for WGSL that some drivers compile wrongly, beyond those of the language. `docs/decisions/lint.md` says which.

use std::collections::BTreeMap;

use naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, Module, Span, Statement, Type, TypeInner,
    valid::{FunctionInfo, ModuleInfo},
};

const MAX_LOOP_DEPTH: u32 = 2;
const MAX_PRIVATE_BYTES: u32 = 4096;

/// A rule that a shader breaks.
#[derive(Debug)]
pub struct Violation {
    /// Where.
    pub span: Span,
    /// The function, the rule, and what to do.
    pub what: String,
}

/// Checks the rules for a module with one entry point.
///
/// # Errors
///
/// Returns the first violation.
pub fn lint(module: &Module, info: &ModuleInfo) -> Result<(), Violation> {
    let entry = (&module.entry_points[0].function, info.get_entry_point(0), "main");
    let functions = module.functions.iter().map(|(handle, function)| {
        let name = function.name.as_deref().unwrap_or_default();
        (function, &info[handle], name)
    });
    for (function, info, name) in functions.chain([entry]) {
        let lint = FunctionLint { module, function, info, name };
        lint.check(&function.body, 0)?;
    }
    check_private_memory(module)?;
    let mut shared = SharedMemory { module, states: BTreeMap::new() };
    shared.follow(entry.0, entry.2, &entry.0.body)
}

/// Checks how much memory each invocation has for itself, if functions are inlined.
fn check_private_memory(module: &Module) -> Result<(), Violation> {
    let bytes = |ty: Handle<Type>| module.types[ty].inner.size(module.to_ctx());
    let entry = &module.entry_points[0].function;
    let functions = module.functions.iter().map(|(_, function)| function).chain([entry]);
    let local = functions.flat_map(|function| function.local_variables.iter()).map(|(_, variable)| variable.ty);
    let private = module.global_variables.iter().filter(|(_, variable)| variable.space == AddressSpace::Private);
    let bytes = local.chain(private.map(|(_, variable)| variable.ty)).map(bytes).sum::<u32>();
    if bytes > MAX_PRIVATE_BYTES {
        let what = format!(
            "local and private variables take {bytes} bytes, more than {MAX_PRIVATE_BYTES}: \
             make arrays smaller, or keep them in a buffer"
        );
        return Err(Violation { span: Span::UNDEFINED, what });
    }
    Ok(())
}

/// The rules that one function shows to be broken.
struct FunctionLint<'a> {
    module: &'a Module,
    function: &'a Function,
    info: &'a FunctionInfo,
    name: &'a str,
}

impl FunctionLint<'_> {
    fn check(&self, block: &Block, depth: u32) -> Result<(), Violation> {
        for (statement, &span) in block.span_iter() {
            let reject = |what: &str| Err(Violation { span, what: format!("function `{}` {what}", self.name) });
            match statement {
                Statement::Block(block) => self.check(block, depth)?,
                Statement::If { accept, reject, .. } => {
                    self.check(accept, depth)?;
                    self.check(reject, depth)?;
                }
                Statement::Loop { .. } if depth == MAX_LOOP_DEPTH => {
                    return reject(
                        "has loops nested more than two deep, of which some drivers run the innermost too few times: \
                         make two of them one, unroll one, or move one to a function",
                    );
                }
                Statement::Loop { body, continuing, .. } => {
                    self.check(body, depth + 1)?;
                    self.check(continuing, depth + 1)?;
                }
                Statement::Switch { .. } => {
                    return reject("has a `switch`, which some drivers compile wrongly: use `if` or `select`");
                }
                Statement::Store { pointer, .. } if self.is_chosen_component(*pointer) => {
                    return reject(
                        "writes a component of a vector that an index chooses, which FXC does not compile: \
                         replace the vector, with `select` for its components",
                    );
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns whether a pointer is to a component of a vector that an index chooses. In buffers of storage, compilers
    /// address it by itself.
    fn is_chosen_component(&self, pointer: Handle<Expression>) -> bool {
        let Expression::Access { base, .. } = self.function.expressions[pointer] else { return false };
        let (is_vector, space) = match *self.info[base].ty.inner_with(&self.module.types) {
            TypeInner::Pointer { base, space } => {
                (matches!(self.module.types[base].inner, TypeInner::Vector { .. }), space)
            }
            TypeInner::ValuePointer { size, space, .. } => (size.is_some(), space),
            _ => return false,
        };
        is_vector && !matches!(space, AddressSpace::Storage { .. })
    }
}

/// How far a workgroup variable has come.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum State {
    Written,
    /// A barrier has followed.
    Ready,
}

/// The workgroup variables that were written, as the text goes, with functions in the place of their calls.
struct SharedMemory<'a> {
    module: &'a Module,
    states: BTreeMap<Handle<GlobalVariable>, State>,
}

impl SharedMemory<'_> {
    fn follow(&mut self, function: &Function, name: &str, block: &Block) -> Result<(), Violation> {
        for (statement, &span) in block.span_iter() {
            let violation = |what: String| Violation { span, what: format!("function `{name}` {what}") };
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        if let Expression::Load { pointer } = function.expressions[expression] {
                            self.read(function, pointer).map_err(violation)?;
                        }
                    }
                }
                Statement::Block(block) => self.follow(function, name, block)?,
                Statement::If { accept, reject, .. } => {
                    let before = self.states.clone();
                    self.follow(function, name, accept)?;
                    let accepted = std::mem::replace(&mut self.states, before);
                    self.follow(function, name, reject)?;
                    self.join(accepted);
                }
                Statement::Loop { body, continuing, .. } => {
                    // The second time, from what the first one leaves.
                    for _ in 0..2 {
                        self.follow(function, name, body)?;
                        self.follow(function, name, continuing)?;
                    }
                }
                Statement::ControlBarrier(_) => self.wait(),
                Statement::WorkGroupUniformLoad { pointer, .. } => {
                    self.wait();
                    self.read(function, *pointer).map_err(violation)?;
                }
                Statement::Store { pointer, .. } => {
                    if let Some(variable) = self.variable(function, *pointer) {
                        self.states.insert(variable, State::Written);
                    }
                }
                Statement::Atomic { pointer, .. } => self.read(function, *pointer).map_err(violation)?,
                // What is handed on can be no pointer to workgroup memory: naga rejects it.
                Statement::Call { function: called, .. } => {
                    let called = &self.module.functions[*called];
                    self.follow(called, called.name.as_deref().unwrap_or_default(), &called.body)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn wait(&mut self) {
        self.states.values_mut().for_each(|state| *state = State::Ready);
    }

    /// Adds what is known of the other branch. Written in one of them counts, since it often is one invocation that
    /// writes.
    fn join(&mut self, other: BTreeMap<Handle<GlobalVariable>, State>) {
        for (variable, state) in other {
            let own = self.states.entry(variable).or_insert(state);
            if state < *own {
                *own = state;
            }
        }
    }

    fn read(&self, function: &Function, pointer: Handle<Expression>) -> Result<(), String> {
        let Some(variable) = self.variable(function, pointer) else { return Ok(()) };
        let GlobalVariable { name, ty, .. } = &self.module.global_variables[variable];
        let name = name.as_deref().unwrap_or_default();
        match self.states.get(&variable) {
            None => Err(format!(
                "reads `{name}` before it is written, but some drivers do not zero workgroup memory: \
                 write it first, and wait for a barrier"
            )),
            Some(State::Written) if self.is_atomic(*ty) => Err(format!(
                "has an atomic operation on `{name}` before a barrier follows its initialisation: \
                 call `workgroupBarrier` between them"
            )),
            Some(_) => Ok(()),
        }
    }

    /// Returns the workgroup variable that a pointer points into.
    fn variable(&self, function: &Function, mut pointer: Handle<Expression>) -> Option<Handle<GlobalVariable>> {
        loop {
            match function.expressions[pointer] {
                Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
                Expression::GlobalVariable(variable) => {
                    let is_shared = self.module.global_variables[variable].space == AddressSpace::WorkGroup;
                    return is_shared.then_some(variable);
                }
                _ => return None,
            }
        }
    }

    fn is_atomic(&self, ty: Handle<Type>) -> bool {
        match self.module.types[ty].inner {
            TypeInner::Atomic(_) => true,
            TypeInner::Array { base, .. } => self.is_atomic(base),
            _ => false,
        }
    }
}
