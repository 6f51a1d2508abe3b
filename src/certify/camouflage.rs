//! How little of a model is recognised from elsewhere: likeness from a ring of eyes around it.
