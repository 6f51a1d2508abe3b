//! Indices as types: a vertex cannot be passed for a face, nor a support for a view.
//!
//! Each is a position in some list, as `u32`. Lists stay plain `Vec`s and slices; any of these types indexes them directly.

/// Defines index types, each with its documentation.
macro_rules! indices {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// # Panics
            /// Above `u32::MAX`: meshes are refused long before they are so large.
            #[inline]
            pub fn new(position: usize) -> Self {
                Self(u32::try_from(position).expect("fewer than 2^32 entries"))
            }

            #[inline]
            pub const fn at(self) -> usize {
                self.0 as usize
            }

            /// The index so many further on: that of the same thing in a list that the first was appended to.
            ///
            /// # Panics
            /// As [`Self::new`].
            #[inline]
            pub fn plus(self, before: usize) -> Self {
                Self::new(self.at() + before)
            }

            /// All indices of a list of this length, rising.
            pub fn all(length: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
                (0..Self::new(length).0 as usize).map(|i| Self(i as u32))
            }
        }

        impl<T> std::ops::Index<$name> for [T] {
            type Output = T;

            #[inline]
            fn index(&self, index: $name) -> &T {
                &self[index.at()]
            }
        }

        impl<T> std::ops::IndexMut<$name> for [T] {
            #[inline]
            fn index_mut(&mut self, index: $name) -> &mut T {
                &mut self[index.at()]
            }
        }

        impl<T> std::ops::Index<$name> for Vec<T> {
            type Output = T;

            #[inline]
            fn index(&self, index: $name) -> &T {
                &self[index.at()]
            }
        }

        impl<T> std::ops::IndexMut<$name> for Vec<T> {
            #[inline]
            fn index_mut(&mut self, index: $name) -> &mut T {
                &mut self[index.at()]
            }
        }
    )*};
}

pub(crate) use indices;

indices! {
    /// A vertex of a mesh.
    VertexId
    /// A face of a mesh.
    FaceId
    /// A part of a mesh whose faces hang together by edges.
    ComponentId
    /// A face of the mesh of all supports together, as rays meet it.
    FacetId
    /// A point of a view map.
    PointId
    /// A cell of a view map.
    CellId
    /// A support of the scene, the base among them.
    SupportId
    /// A depth group of a view.
    GroupId
    /// A view of the scene.
    ViewId
}

impl FacetId {
    /// The facet that is this face of the mesh of all supports.
    pub const fn of(face: FaceId) -> Self {
        Self(face.0)
    }

    /// As a face of that mesh.
    pub const fn face(self) -> FaceId {
        FaceId(self.0)
    }
}
