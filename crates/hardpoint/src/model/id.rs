//! Indices of the parts of a model.

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);
    )*};
}

ids! {
    /// A hardpoint's place in [`Model::hardpoints`](super::Model::hardpoints).
    HardpointId
    /// A parameter's place in [`Model::parameters`](super::Model::parameters).
    ParameterId
    /// A body's place in [`Model::bodies`](super::Model::bodies); 0 is ground.
    BodyId
    /// A joint's place in [`Model::joints`](super::Model::joints).
    JointId
    /// A driver's place in [`Model::drivers`](super::Model::drivers).
    DriverId
    /// A design variable's place in [`Model::variables`](super::Model::variables).
    VariableId
    /// A body point's place in [`Model::points`](super::Model::points).
    PointId
    /// A wheel's place in [`Model::wheels`](super::Model::wheels).
    WheelId
    /// An axle's place in [`Model::axles`](super::Model::axles).
    AxleId
    /// A shape's place in [`Model::shapes`](super::Model::shapes).
    ShapeId
    /// A clearance's place in [`Model::clearances`](super::Model::clearances).
    ClearanceId
    /// A measure's place in [`Model::measures`](super::Model::measures).
    MeasureId
    /// A case's place in [`Model::cases`](super::Model::cases).
    CaseId
}

/// The body that does not move.
pub const GROUND: BodyId = BodyId(0);
