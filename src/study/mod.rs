//! What accuracy costs in time: competitors at equal budgets, their errors, and how sure that is.

pub mod peer;
pub mod results;
pub mod statistics;
