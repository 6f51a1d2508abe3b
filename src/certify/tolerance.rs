//! How far an eye may move until a cut opens, and from where two eyes see one object.
