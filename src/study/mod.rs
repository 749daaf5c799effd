//! What accuracy costs in time: competitors at equal budgets, their errors, and how sure that is.

pub mod report;
pub mod results;
pub mod statistics;
